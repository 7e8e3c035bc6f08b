// SPDX-License-Identifier: MIT
#pragma once

#include "drivers/can/can_map.h"

namespace framewatch::drivers {

/// Returns the bits of a classical frame on the wire, with interframe space and the stuff bits of
/// the worst data: 135 for 8 bytes with an 11-bit id, 160 with a 29-bit id.
int worst_classical_bits(int bytes, bool extended);

/// Returns the longest time of a frame on the wire in s. `data_bit_rate` is the bit rate of the
/// data of a CAN FD frame. Bit rates are in bit/s.
double worst_frame_s(int bytes, bool extended, bool fd, int bit_rate, int data_bit_rate);

/// The load of a bus by configured nodes and SYNCs.
struct BusLoad {
  double share = 0;  ///< of the time, 0..1, in the worst case
  double frames_hz = 0;
};
/// Returns the load of the bus with this index.
BusLoad bus_load(const CanMap& map, int bus);

/// Above this share, frames wait long behind others and losses become likely.
inline constexpr double kHighBusLoad = 0.5;

}  // namespace framewatch::drivers
