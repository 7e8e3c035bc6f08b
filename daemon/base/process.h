// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// Returns the name of a user, or "uid 1234". Can block as long as a directory server.
std::string user_name(uid_t user);
/// Returns the name of a group, or "gid 1234".
std::string group_name(gid_t group);

/// Returns a random number from 1 to 2^52. Identifies a request over LCM, so that its sender finds
/// the answer.
std::int64_t random_id();

/// A child process that runs this program or another one. Its failure does not harm the caller.
class ChildProcess {
 public:
  /// Starts `program` with `arguments`. Returns nullopt and sets `error` if that fails. `errors`:
  /// file for its standard error, or empty for this program's.
  static std::optional<ChildProcess> start(std::vector<std::string> arguments, std::string& error,
                                           const std::string& program = "/proc/self/exe",
                                           const std::string& errors = "");

  /// Returns the exit code of the process, or 128 plus the signal that ended it. Returns nullopt
  /// while it runs.
  std::optional<int> ended();

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_;
};

/// Memory and CPU time of this process.
struct ProcessUsage {
  std::int64_t resident_bytes = 0;
  double cpu_s = 0;  ///< since its start, including system time
};
ProcessUsage process_usage();

/// Returns the bytes that this process can still write to the file system of `path`, which need not
/// exist. Returns -1 if unknown.
std::int64_t disk_free_bytes(const std::string& path);

}  // namespace framewatch::daemon
