// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

/// `source` of a [[channel]]: origin of a sensor axis' samples. CAN if `can` names an interface,
/// else LCM. With sensor_node < 0, only files have the channel, matched by name.
struct AxisSource {
  std::string lcm_channel;
  int sensor_node = -1;  ///< number of the sensor node in its messages
  int axis = 0;          ///< axis of the sensor node: 0 x, 1 y, 2 z
  std::string can = {};
  std::string dbc_signal = {};  ///< Message.Signal
  std::string can_node = {};
};

}  // namespace framewatch::daemon
