// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/monitor/live/live_estimation.h"

namespace framewatch::daemon {

struct RunArguments {
  std::string config;
  std::string url;  ///< empty: as configured
  bool quiet = false;
  bool by_name = false;      ///< nodes name the channels that have no source
  std::string state = {};    ///< file that keeps the state over a restart; empty: not kept
  int state_every_s = 60;    ///< seconds between two writes of the state
  int stop_within_s = 8;     ///< longest time from a stop signal to the end of the process
  std::string can_log = {};  ///< file for the frames of the CAN buses; empty: not written
};

/// Runs `framewatch run` until SIGINT or SIGTERM. Returns the exit code.
int run(const RunArguments& arguments);

}  // namespace framewatch::daemon
