#include "estimator/gap/driving_axes.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {

DrivingAxes::DrivingAxes(const std::vector<SensorAxis>& axes, double rate_hz)
    : axes_(axes),
      all_(identifying(axes)),
      present_(all_),
      seen_(all_),
      enough_instants_(static_cast<int>(std::ceil(kSteady_s * rate_hz))) {}

bool DrivingAxes::drives(std::size_t axis) const {
  return all_[axis] != 0 && (axes_[axis].story == 0 || axes_[axis].is_force);
}

bool DrivingAxes::push(const std::vector<double>& values) {
  bool same = true;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const std::uint8_t now = !drives(a) || !std::isnan(values[a]) ? all_[a] : 0;
    same = same && now == seen_[a];
    seen_[a] = now;
  }
  steady_ = same ? std::min(steady_ + 1, enough_instants_) : 0;
  if (steady_ < enough_instants_ || seen_ == present_ || !enough(seen_)) return false;
  present_ = seen_;
  return true;
}

bool DrivingAxes::enough(const std::vector<std::uint8_t>& present) const {
  for (std::size_t lost = 0; lost < axes_.size(); ++lost) {
    const SensorAxis& axis = axes_[lost];
    if (present[lost] == all_[lost] || axis.vertical) continue;
    bool replaced = false;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      replaced = replaced || (drives(a) && present[a] != 0 && axes_[a].horizontal() &&
                              axes_[a].direction == axis.direction);
    if (axis.is_force || !replaced) return false;
  }
  return true;
}

bool DrivingAxes::restore(const std::vector<std::uint8_t>& present,
                          const std::vector<std::uint8_t>& seen) {
  for (const auto* flags : {&present, &seen}) {
    if (flags->size() != all_.size()) return false;
    for (std::size_t a = 0; a < all_.size(); ++a)
      if ((*flags)[a] > all_[a] || (!drives(a) && (*flags)[a] != all_[a])) return false;
  }
  if (!enough(present)) return false;
  present_ = present;
  seen_ = seen;
  return true;
}

}  // namespace framewatch::estimator
