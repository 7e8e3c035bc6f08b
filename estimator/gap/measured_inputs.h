// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The external inputs that move a building, as its axes measure them: the base's translations and
/// its rotation about the vertical, its rocking by the base's vertical axes (docs/equations.md),
/// and forces. Inputs that no axis measures count as 0.
struct MeasuredInputs {
  Inputs inputs;
  Eigen::MatrixXd from_axes;       ///< inputs x all axes: m/s^2, rad/s^2 or N of what the axes read
  std::vector<Eigen::Index> used;  ///< axes that measure an input
};
/// present: by axis; 1: present.
MeasuredInputs measured_inputs(const Structure& structure, const std::vector<SensorAxis>& axes,
                               const std::vector<std::uint8_t>& present);

/// Selects the axes that measure the inputs: those of the base and forces, except axes for checks.
/// An axis without values for two seconds is dropped if every direction and every force remains
/// measured. It returns after two seconds with values.
class DrivingAxes {
 public:
  DrivingAxes(const std::vector<SensorAxis>& axes, double rate_hz);

  /// Takes the values of all axes at the next instant, NaN: no value. Returns true when the
  /// selection changed.
  bool push(const std::vector<double>& values);
  /// Returns flags of all axes; those that move with the floors are always present.
  const std::vector<std::uint8_t>& present() const { return present_; }

  void archive(auto& a) {
    std::vector<std::uint8_t> present = present_, seen = seen_;
    a(present, seen);
    a.within(steady_, 0, a.kMaxCount);
    if (a.kReading)
      if (!restore(present, seen)) a.refuse();
  }

 private:
  static constexpr double kSteady_s = 2;
  bool drives(std::size_t axis) const;
  bool enough(const std::vector<std::uint8_t>& present) const;
  bool restore(const std::vector<std::uint8_t>& present, const std::vector<std::uint8_t>& seen);

  std::vector<SensorAxis> axes_;
  std::vector<std::uint8_t> all_, present_, seen_;
  int steady_ = 0;  ///< instants with the same seen_
  int enough_instants_;
};

}  // namespace framewatch::estimator
