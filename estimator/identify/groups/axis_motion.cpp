#include "estimator/identify/groups/axis_motion.h"

namespace framewatch::estimator {

DeformationSet AxisMotion::make_set() const {
  const auto axes = static_cast<std::size_t>(axes_);
  return {std::vector<double>(axes * kSignals, 0.0), std::vector<std::uint8_t>(axes, 0)};
}

void AxisMotion::compute(const DriftControlledIntegrator& motion, DeformationSet& set) const {
  double* out = set.values.data();
  for (int axis = 0; axis < axes_; ++axis) {
    set.known[static_cast<std::size_t>(axis)] = motion.valid(axis) ? 1 : 0;
    *out++ = motion.value(axis);
    *out++ = motion.first(axis);
    *out++ = motion.second(axis);
    *out++ = motion.held_first(axis);
    *out++ = motion.held_second(axis);
  }
}

}  // namespace framewatch::estimator
