// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/can/can_map.h"

namespace framewatch::drivers {

/// A frame and the index of its bus.
struct BusFrame {
  int bus = 0;
  CanFrame frame;
};

/// Makes the frames that the nodes of a map would send: the inverse of CanIntake, for virtual
/// buildings and tests.
class CanEncoder {
 public:
  /// `map` must outlive this object.
  explicit CanEncoder(const CanMap& map);

  /// Returns the frames of the next instant in the order of a bus: the SYNC of every bus with nodes
  /// that sample at it, then the nodes by id. `values` are by axis in the unit of the signals and
  /// are clamped to their range. A node with a NaN sends no frame, though its counter goes on.
  /// Stamps are 0.
  std::vector<BusFrame> instant(const std::vector<double>& values);

 private:
  void add_node(std::size_t index, const std::vector<double>& values, std::vector<BusFrame>& out);

  const CanMap& map_;
  std::vector<std::size_t> order_;          ///< nodes by the id that opens their sample
  std::vector<std::vector<double>> block_;  ///< by node: values for one frame
  std::int64_t instant_ = 0;
};

}  // namespace framewatch::drivers
