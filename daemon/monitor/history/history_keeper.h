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
  void look();
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
