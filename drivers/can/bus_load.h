#pragma once

#include <string>
#include <vector>

#include "drivers/can/can_map.h"

namespace framewatch::drivers {

/// Bits of a classical frame on the wire, interframe space included, with as many stuff bits as the
/// worst data make: 135 for 8 bytes with an 11-bit id, 160 with a 29-bit one.
int worst_classical_bits(int bytes, bool extended);

/// Longest time of a frame on the wire, s. `data_bit_rate` is that of a CAN FD frame's data.
double worst_frame_s(int bytes, bool extended, bool fd, int bit_rate, int data_bit_rate);

/// What the configured nodes and SYNCs take of a bus.
struct BusLoad {
  double share = 0;  ///< 0..1 of the time, worst case
  double frames_hz = 0;
};
BusLoad bus_load(const CanMap& map, int bus);

/// Above this, queueing behind other frames makes latencies long and losses likely.
inline constexpr double kHighBusLoad = 0.5;

}  // namespace framewatch::drivers
