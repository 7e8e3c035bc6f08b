// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "drivers/can/can_source.h"

namespace framewatch::test {

/// Returns `configs/can/NAME.toml` with its only bus on another interface.
daemon::Config example_on(const std::string& name, const std::string& interface);

/// Runs a shell command that must succeed.
void shell(const std::string& command);

/// A virtual bus that exists as long as this object.
struct Vcan {
  explicit Vcan(std::string name_) : name(std::move(name_)) { up(); }
  ~Vcan() { down(); }
  Vcan(const Vcan&) = delete;
  Vcan& operator=(const Vcan&) = delete;
  void up() const { shell("ip link add " + name + " type vcan && ip link set " + name + " up"); }
  void down() const { shell("ip link del " + name); }
  std::string name;
};

/// configs/can/scenario_tower.toml
inline constexpr const char* kTowerScenario =
    FRAMEWATCH_SOURCE_DIR "/configs/can/scenario_tower.toml";

/// Returns estimates of a scenario's samples over LCM, quantized as its CAN nodes do.
std::vector<estimator::WindowEstimate> estimates_over_lcm(const std::string& scenario,
                                                          double seconds);

/// Counts windows whose values, errors or reasons differ in any byte; all windows if their numbers
/// differ.
std::size_t different(const std::vector<estimator::WindowEstimate>& a,
                      const std::vector<estimator::WindowEstimate>& b);

/// A process; the destructor waits for its end.
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

/// Reads the buses of a configuration live in this process.
class LiveBuses : private daemon::EstimationListener {
 public:
  explicit LiveBuses(const daemon::Config& config);
  /// Handles frames until `done` is true, and for half a second more.
  void run(const std::function<bool()>& done);

  void on_estimate(const estimator::WindowEstimate& e) override { estimates.push_back(e); }

  std::vector<estimator::WindowEstimate> estimates;
  daemon::Estimation estimation;
  drivers::CanSource source;
};

}  // namespace framewatch::test
