#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// Gives the .partial logs in a folder that no program writes any more their names: the event that
/// was being written is cut off, nothing else is touched. One in which there is no whole event is
/// put aside as .damaged; an empty one is removed. Says so in the log.
void repair_raw_logs(const std::string& folder);

/// Removes the unfinished compressed files that a killed program left in a folder.
void remove_unfinished_compressions(const std::string& folder);

/// Compresses PATH to PATH.zst. After a failure, which is logged, or when `stop` becomes true, PATH
/// stays.
void compress_raw_log(const std::string& path, const std::atomic<bool>& stop);

struct TimeSpan {
  std::int64_t from_us, to_us;
};
/// Writes those blocks of a raw log that have samples within a span, into a log of the same name in
/// `folder`; none when there is no such block. Empty, or why not; then nothing was written.
std::string excerpt_raw_log(const std::string& path, const std::vector<TimeSpan>& spans,
                            const std::string& folder);

}  // namespace framewatch::daemon
