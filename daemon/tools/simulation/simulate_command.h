// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

struct SimulateArguments {
  std::string scenario;
  std::string out;            ///< .csv, .csv.gz or .lcmlog; empty for no file
  std::string truth;          ///< JSON file of the true values; empty for none
  std::string history;        ///< folder of a history of the climate; empty for none
  std::string weather;        ///< CSV file of the hours of the weather; empty for none
  bool lcm = false;           ///< publish live
  std::string lcm_url;        ///< empty for the configuration's
  bool can = false;           ///< send CAN frames
  std::string can_interface;  ///< empty for the configuration's
  double speed = 1;           ///< speed of the live stream as a multiple of real time
  double seconds = -1;        ///< replaces the scenario's duration if > 0
  bool quiet = false;
};

/// Runs `framewatch simulate`. Returns the exit code.
int simulate(const SimulateArguments& arguments);

}  // namespace framewatch::daemon
