#include "estimator/motion/calibration.h"

#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kGravity = 9.80665;

}  // namespace

Calibration::Calibration(const std::vector<SensorAxis>& axes) : straight_(axes.size()) {
  for (const SensorAxis& axis : axes) {
    Axis out;
    out.gain = axis.polarity / std::cos(axis.tilt);
    out.offset = axis.offset + axis.polarity * kGravity * std::sin(axis.tilt);
    out.cross = axis.cross;
    if (axis.cross >= 0) {
      // mx = cos(a) ax + sin(a) ay of an x axis, my = cos(b) ay - sin(b) ax of a y axis, angles
      // counter-clockwise.
      const SensorAxis& other = axes[static_cast<std::size_t>(axis.cross)];
      const double sign = axis.direction == Direction::x ? 1 : -1;
      const double determinant = std::cos(axis.mount_angle - other.mount_angle);
      out.own = std::cos(other.mount_angle) / determinant;
      out.other = -sign * std::sin(axis.mount_angle) / determinant;
    }
    axes_.push_back(out);
  }
}

void Calibration::apply(std::vector<double>& accel) {
  for (std::size_t a = 0; a < axes_.size(); ++a)
    straight_[a] = axes_[a].gain * (accel[a] - axes_[a].offset);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    accel[a] = axis.cross < 0 ? straight_[a]
                              : axis.own * straight_[a] +
                                    axis.other * straight_[static_cast<std::size_t>(axis.cross)];
  }
}

}  // namespace framewatch::estimator
