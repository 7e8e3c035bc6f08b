#pragma once

#include <string>

namespace framewatch::daemon {

/// source of a [[channel]]: where a sensor axis' samples come from. On LCM; sensor_node < 0: file
/// only, matched by channel name. Or on CAN, when `can` names an interface.
struct AxisSource {
  std::string lcm_channel;
  int sensor_node = -1;  ///< number of the sensor node in its messages
  int axis = 0;          ///< of the sensor node: 0 x, 1 y, 2 z
  std::string can = {};
  std::string dbc_signal = {};  ///< Message.Signal
  std::string can_node = {};
};

}  // namespace framewatch::daemon
