#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace framewatch::daemon {

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

}  // namespace framewatch::daemon
