#pragma once

#include <string>

#include "daemon/monitor/live/live_estimation.h"

namespace framewatch::daemon {

struct RunArguments {
  std::string config;
  std::string url;  ///< empty: the configuration's
  bool quiet = false;
  bool by_name = false;      ///< nodes name the channels that have no source
  std::string state = {};    ///< file that keeps the state over a restart; empty: none
  int state_every_s = 60;    ///< period of its writes
  std::string can_log = {};  ///< file for the frames of the CAN buses; empty: none
};

/// framewatch run: until SIGINT or SIGTERM. Exit code.
int run(const RunArguments& arguments);

}  // namespace framewatch::daemon
