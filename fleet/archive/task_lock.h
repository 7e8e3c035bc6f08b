#pragma once

#include <string>

namespace framewatch::fleet {

/// One process at a time does a task: who comes second waits until the first has ended, well or
/// not. A file beside the task's output, gone with the lock.
class TaskLock {
 public:
  TaskLock() = default;
  ~TaskLock();
  TaskLock(const TaskLock&) = delete;
  TaskLock& operator=(const TaskLock&) = delete;

  /// Waits. Empty, or why not.
  std::string take(const std::string& path);

 private:
  std::string path_;
  int file_ = -1;
};

}  // namespace framewatch::fleet
