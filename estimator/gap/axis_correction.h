// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/structure/effect.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// Removes the sensor errors that a model knows (effects of channels) from measured accelerations,
/// so that they compare with the building's motion. The high-pass removes a drifting bias.
class AxisCorrection {
 public:
  /// axes: with the remaining fractions of their delays.
  AxisCorrection(const std::vector<SensorAxis>& axes, const std::vector<Effect>& effects,
                 double rate_hz);

  /// Returns the instants by which all axes are delayed to wait for the latest.
  int held_back() const { return longest_; }
  /// Returns the remaining fraction of each axis' delay, at most half an instant, in instants.
  const std::vector<double>& rest() const { return rest_; }
  /// Corrects one instant. accel: one value per axis, NaN if missing. The result is valid until the
  /// next call.
  const std::vector<double>& apply(const std::vector<double>& accel);

  void archive(auto& a) {
    a(ring_);
    a.within(newest_, 0, length_ - 1);
  }

 private:
  std::vector<Effect> effects_;
  std::size_t axes_;
  int longest_ = 0;
  std::vector<int> whole_;  ///< delays, instants
  std::vector<double> rest_;
  std::vector<double> ring_;  ///< instants x axes
  int newest_ = 0, length_ = 1;
  std::vector<double> aligned_;
};

}  // namespace framewatch::estimator
