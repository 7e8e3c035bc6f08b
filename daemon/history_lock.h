#pragma once

#include <string>

namespace framewatch::daemon {

/// At most one program writes a history's summaries: two would count every window twice. Held until
/// the program ends, however it ends.
class HistoryLock {
 public:
  HistoryLock() = default;
  ~HistoryLock();
  HistoryLock(const HistoryLock&) = delete;
  HistoryLock& operator=(const HistoryLock&) = delete;

  /// Empty, or why not. Once it is held it stays.
  std::string take(const std::string& directory);

 private:
  int file_ = -1;
};

}  // namespace framewatch::daemon
