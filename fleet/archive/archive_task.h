// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::fleet {

/// A part of an archive that is identified again in one run: one line of a manifest.
struct ArchiveTask {
  int number = 0;   ///< of the line, from 1
  std::string key;  ///< digest of everything that the output depends on: task_key()
  std::string config;
  std::string out;                      ///< path of the output, without its ending
  std::int64_t warm_up_us = 0;          ///< sensor time from which samples are used
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time that is stored
  std::vector<std::string> logs = {};   ///< in order of time
  bool operator==(const ArchiveTask&) const = default;
};

/// Returns the part of the key that depends on the program and the configuration.
std::string making_of(const std::string& program, const std::string& config_sha256);
/// Returns the whole key: `making` and a digest of the times and logs. log_sha256: as task.logs.
std::string task_key(const std::string& making, const ArchiveTask& task,
                     const std::vector<std::string>& log_sha256);

/// Returns a line of words between tabs: number, key, configuration, output, the three times in
/// microseconds, logs.
std::string manifest_line(const ArchiveTask& task);
/// Returns nullopt and sets `problem` to the broken rule if the line is not a task.
std::optional<ArchiveTask> read_manifest_line(std::string_view line, std::string& problem);
/// Reads all lines of a manifest. Returns nullopt and sets `problem` to file, line and rule if a
/// line is not a task or does not have the number of its line.
std::optional<std::vector<ArchiveTask>> read_manifest(const std::string& path,
                                                      std::string& problem);

/// Lets only one process at a time run a task; others wait until it ends, even if it crashes. Locks
/// a file beside the task's output and removes it at the end.
class TaskLock {
 public:
  TaskLock() = default;
  ~TaskLock();
  TaskLock(const TaskLock&) = delete;
  TaskLock& operator=(const TaskLock&) = delete;

  /// Waits for the lock. Returns an empty text, or the problem.
  std::string take(const std::string& path);

 private:
  std::string path_;
  int file_ = -1;
};

/// Returns a SHA-256 that differs between programs with different code: of the version and the
/// linker's build id, or of the program file without a build id. Returns an empty text if the file
/// cannot be read.
std::string program_identity();

}  // namespace framewatch::fleet
