#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::fleet {

/// A stretch of an archive that is identified anew in one piece: one line of a manifest.
struct ArchiveTask {
  int number = 0;   ///< of the line, from 1
  std::string key;  ///< what the output depends on: see task_key()
  std::string config;
  std::string out;                      ///< of the output, without its ending
  std::int64_t warm_up_us = 0;          ///< sensor time from which samples are used
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time that is stored
  std::vector<std::string> logs = {};   ///< in order of time
  bool operator==(const ArchiveTask&) const = default;
};

/// The key's part that says by what and how an output is made: program and configuration.
std::string making_of(const std::string& program, const std::string& config_sha256);
/// The whole key: `making`, and what of which time is read. `log_sha256` as task.logs.
std::string task_key(const std::string& making, const ArchiveTask& task,
                     const std::vector<std::string>& log_sha256);

/// Words between tabs: number, key, configuration, output, the three times in microseconds, logs.
std::string manifest_line(const ArchiveTask& task);
/// Empty, with the rule that it breaks, when the line is no task.
std::optional<ArchiveTask> read_manifest_line(std::string_view line, std::string& problem);
/// Every line of a manifest. Empty, with file, line and rule, when one is no task or its number is
/// not that of its line.
std::optional<std::vector<ArchiveTask>> read_manifest(const std::string& path,
                                                      std::string& problem);

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

/// SHA-256 that two programs share only when they do the same: of the version and the build id that
/// the linker made of the program's content; of the file where it has none. Empty when it cannot be
/// read.
std::string program_identity();

}  // namespace framewatch::fleet
