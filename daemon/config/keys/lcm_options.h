// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "drivers/lcm/lcm_settings.h"

namespace framewatch::daemon {

/// [commands]: how running daemons receive commands, docs/operate.md.
struct CommandSettings {
  std::string directory;  ///< directory of the sockets; empty uses command_directories()
};

/// [lcm]: the bus the samples come from and the estimates go to.
struct LcmSettings {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "FRAMEWATCH_";  ///< prefix of the daemon's channels
  int queue_capacity = 10000;          ///< messages waiting for the estimator
  drivers::LcmReception reception;
  bool commands = false;  ///< accept commands over LCM
  int boxplot_every = 1;  ///< publish boxplot statistics with every n-th window
  drivers::TwoSenders two_senders =
      drivers::TwoSenders::first;  ///< policy for two senders with one node
};

}  // namespace framewatch::daemon
