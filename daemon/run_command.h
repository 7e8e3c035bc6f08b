#pragma once

#include <string>

#include <lcm/lcm-cpp.hpp>

#include "daemon/estimation.h"
#include "drivers/lcm_source.h"

namespace framewatch::daemon {

/// Live estimation on one LCM instance: samples from it, estimates to it. poll() until satisfied.
class LiveEstimation {
 public:
  /// `config` and `lcm` must outlive this. For memq:// everybody shares `lcm`.
  LiveEstimation(const Config& config, lcm::LCM& lcm);

  /// Waits for messages at most `timeout_ms` and handles those that are there. False when LCM
  /// failed. Never throws, never stops on bad input.
  [[nodiscard]] bool poll(int timeout_ms);
  void finish() { estimation_.finish(); }
  const Estimation& estimation() const { return estimation_; }
  Estimation& estimation() { return estimation_; }
  const LiveState& state() const { return state_; }

 private:
  void on_message(const std::string& channel, const void* data, std::size_t size,
                  std::int64_t received_us);

  lcm::LCM& lcm_;
  LiveState state_;
  Estimation estimation_;
  drivers::LcmSource source_;
};

struct RunArguments {
  std::string config;
  std::string url;  ///< empty: the configuration's
  bool quiet = false;
  std::string state = {};  ///< file that carries the state over a restart; empty: none
  int state_every_s = 60;  ///< between two writes of it
};

/// framewatch run: until SIGINT or SIGTERM. Exit code.
int run(const RunArguments& arguments);

}  // namespace framewatch::daemon
