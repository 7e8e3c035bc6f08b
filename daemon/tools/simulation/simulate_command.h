#pragma once

#include <string>

namespace framewatch::daemon {

struct SimulateArguments {
  std::string scenario;
  std::string out;            ///< .csv, .csv.gz or .lcmlog; empty: no file
  std::string truth;          ///< JSON of what is hidden; empty: none
  bool lcm = false;           ///< publish live
  std::string lcm_url;        ///< empty: the configuration's
  bool can = false;           ///< send CAN frames
  std::string can_interface;  ///< empty: the configuration's
  double speed = 1;           ///< of the live stream, times real time
  double seconds = -1;        ///< instead of the scenario's duration when > 0
  bool quiet = false;
};

/// framewatch simulate. Exit code.
int simulate(const SimulateArguments& arguments);

}  // namespace framewatch::daemon
