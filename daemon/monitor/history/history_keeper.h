#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "daemon/config/keys/history_options.h"
#include "drivers/files/durable_file.h"

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

/// Removes closed raw logs that are older than keep_days before `now_us`, and the oldest while
/// there is more than keep_gb of them. Samples of an event of kind gap or
/// stiffness_change are first copied to the folder of events; the log stays when that fails.
void remove_old_raw_logs(const HistorySettings& settings, std::int64_t now_us);

/// Does the slow work on raw logs in a thread of idle priority (SCHED_IDLE): closes them, repairs
/// those of a killed program, compresses them, removes the oldest. Samples of an event of kind gap
/// or stiffness_change are kept for ever.
class HistoryKeeper {
 public:
  struct Room {
    std::int64_t stored_bytes = 0;
    std::int64_t free_bytes = -1;  ///< on the disk; -1: not known
  };

  explicit HistoryKeeper(HistorySettings settings);
  /// Closes what waits for it.
  ~HistoryKeeper();
  HistoryKeeper(const HistoryKeeper&) = delete;
  HistoryKeeper& operator=(const HistoryKeeper&) = delete;

  void retire(std::unique_ptr<drivers::DurableFile> log);
  /// Newest sensor time, from which the age of a log is counted.
  void newest(std::int64_t time_us);
  Room room() const;

 private:
  void work();
  void close_retired();
  void tidy();
  void guarded(const std::function<void()>& work);

  HistorySettings settings_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;  ///< guards what is below
  std::condition_variable wake_;
  std::vector<std::unique_ptr<drivers::DurableFile>> retired_;
  std::int64_t newest_us_ = INT64_MIN;
  Room room_;
  std::thread thread_;  ///< last: it sees everything above
};

}  // namespace framewatch::daemon
