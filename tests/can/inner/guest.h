#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/estimation.h"
#include "drivers/can/can_source.h"

namespace framewatch::test {

/// `configs/can/NAME.toml` with its (one) bus on another interface.
daemon::Config example_on(const std::string& name, const std::string& interface);

/// Runs a command of a shell that must succeed.
void shell(const std::string& command);

/// A process; waited for at the end.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  bool ended();

 private:
  pid_t pid_;
  bool ended_ = false;
};

/// The buses of a configuration, live, in this process.
class LiveBuses {
 public:
  explicit LiveBuses(const daemon::Config& config);
  /// Handles frames until `done` is true, and half a second more.
  void run(const std::function<bool()>& done);

  std::vector<WindowEstimate> estimates;
  daemon::Estimation estimation;
  drivers::CanSource source;
};

}  // namespace framewatch::test
