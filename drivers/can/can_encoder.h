#pragma once

#include <cstdint>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/can/can_map.h"

namespace framewatch::drivers {

struct BusFrame {
  int bus = 0;
  CanFrame frame;
};

/// What the nodes of a map would send: the inverse of CanIntake, for virtual buildings and tests.
class CanEncoder {
 public:
  /// `map` must outlive this.
  explicit CanEncoder(const CanMap& map);

  /// Frames of one instant in the order of a bus: the SYNC of every bus that has latched nodes,
  /// then the nodes by id. `values` by axis, in the signals' unit, clamped to their range; a node
  /// with a NaN sends nothing then, though its counter goes on. Stamps are left 0.
  std::vector<BusFrame> instant(const std::vector<double>& values);

  /// A value as it comes back after its way over the bus.
  double quantised(int axis, double value) const;

 private:
  void add_node(std::size_t index, const std::vector<double>& values, std::vector<BusFrame>& out);

  const CanMap& map_;
  std::vector<std::size_t> order_;          ///< nodes, by the id that opens their sample
  std::vector<std::vector<double>> block_;  ///< by node: values of the instants of one frame
  std::int64_t instant_ = 0;
};

}  // namespace framewatch::drivers
