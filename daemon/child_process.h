#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// This program with other arguments, in a process of its own: what goes wrong there is no harm
/// here.
class ChildProcess {
 public:
  /// Empty, with the reason, when it cannot be started.
  static std::optional<ChildProcess> start(std::vector<std::string> arguments, std::string& error);

  /// Its exit code, 128 and its signal when one ended it; empty while it runs.
  std::optional<int> ended();

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_;
};

}  // namespace framewatch::daemon
