#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// Name of a user of this machine; "uid 1234" without one. May take as long as a directory server.
std::string user_name(uid_t user);
/// Name of a group; "gid 1234" without one.
std::string group_name(gid_t group);

/// 1 to 2^52, by chance: who asks over LCM knows the answer by it.
std::int64_t random_id();

/// Runs this program, or another, with other arguments in a child process, whose failure does not
/// harm the caller.
class ChildProcess {
 public:
  /// Empty, with the reason, when it cannot be started. errors: file that gets what it says on its
  /// standard error; empty: ours.
  static std::optional<ChildProcess> start(std::vector<std::string> arguments, std::string& error,
                                           const std::string& program = "/proc/self/exe",
                                           const std::string& errors = "");

  /// The exit code of the process, 128 plus the signal that ended it; empty while it runs.
  std::optional<int> ended();

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_;
};

/// Memory and processor time that this process uses.
struct ProcessUsage {
  std::int64_t resident_bytes = 0;
  double cpu_s = 0;  ///< since its start, system included
};
ProcessUsage process_usage();

/// Bytes that this process can still write to the file system of `path`, which need not exist yet;
/// -1 when it is not known.
std::int64_t disk_free_bytes(const std::string& path);

}  // namespace framewatch::daemon
