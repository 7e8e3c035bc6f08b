#pragma once

#include <string>

namespace framewatch::daemon {

/// A lock, because two programs that write summaries would count every window twice. The kernel
/// releases it when the program ends, even by a crash.
class HistoryLock {
 public:
  HistoryLock() = default;
  ~HistoryLock();
  HistoryLock(const HistoryLock&) = delete;
  HistoryLock& operator=(const HistoryLock&) = delete;

  /// Takes the lock and keeps it. Returns an empty string, or the reason of a failure.
  std::string take(const std::string& directory);

 private:
  int file_ = -1;
};

}  // namespace framewatch::daemon
