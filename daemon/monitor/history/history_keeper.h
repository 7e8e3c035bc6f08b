// SPDX-License-Identifier: MIT
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

/// Closes the .partial logs in a folder that no program writes any more. Cuts off an unfinished
/// event at the end and renames the log. Names a log without an intact event .damaged, and removes
/// an empty one. Logs each repair.
void repair_raw_logs(const std::string& folder);

/// Removes the unfinished compressed files that a killed program left in a folder.
void remove_unfinished_compressions(const std::string& folder);

/// Compresses PATH to PATH.zst and removes PATH. Keeps PATH after a failure, which is logged, and
/// when `stop` becomes true.
void compress_raw_log(const std::string& path, const std::atomic<bool>& stop);

struct TimeSpan {
  std::int64_t from_us, to_us;
};
/// Copies the blocks of a raw log with samples within one of the spans to a log of the same name in
/// `folder`. Writes no log if no block has such samples. Returns an empty string. On failure,
/// returns the problem and writes nothing.
std::string excerpt_raw_log(const std::string& path, const std::vector<TimeSpan>& spans,
                            const std::string& folder);

/// Removes closed raw logs that are older than keep_days before `now_us`, and the oldest ones while
/// their total exceeds keep_gb. First copies samples around gap and stiffness_change events to the
/// folder of events; keeps the log if that fails.
void remove_old_raw_logs(const HistorySettings& settings, std::int64_t now_us);

/// Does the slow work on raw logs in a thread of idle priority (SCHED_IDLE): closes them, repairs
/// those of a killed program, compresses them, removes the oldest. Keeps the samples around gap and
/// stiffness_change events forever.
class HistoryKeeper {
 public:
  struct Room {
    std::int64_t stored_bytes = 0;
    std::int64_t free_bytes = -1;  ///< on the disk; -1: not known
  };

  explicit HistoryKeeper(HistorySettings settings);
  /// Closes the logs that wait for it.
  ~HistoryKeeper();

  void retire(std::unique_ptr<drivers::DurableFile> log);
  /// Sets the newest sensor time, from which the age of a log is counted.
  void newest(std::int64_t time_us);
  Room room() const;

 private:
  void work();
  void close_retired();
  void tidy();
  void guarded(const std::function<void()>& work);

  HistorySettings settings_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable wake_;
  std::vector<std::unique_ptr<drivers::DurableFile>> retired_;
  std::int64_t newest_us_ = INT64_MIN;
  Room room_;
  std::thread thread_;  ///< last, because it uses the members above
};

}  // namespace framewatch::daemon
