#pragma once

#include <string>

namespace framewatch::daemon {

/// [lcm]: the bus the samples come from and the estimates go to.
struct LcmSettings {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "FRAMEWATCH_";  ///< of the channels the daemon publishes on
  int queue_capacity = 10000;          ///< messages waiting for the estimator
  int receive_buffer_bytes = 4194304;
  int boxplot_every = 1;  ///< publish boxplot statistics with every n-th window
};

}  // namespace framewatch::daemon
