#include "daemon/tools/session/rest_level.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch::daemon {
namespace {

constexpr double kSettled_s = 1, kMemory_s = 5;

}  // namespace

RestLevel::RestLevel(std::size_t axes, double rate_hz)
    : settled_(std::lround(kSettled_s * rate_hz)),
      memory_(std::lround(kMemory_s * rate_hz)),
      axes_(axes),
      distance_(axes) {}

const std::vector<double>& RestLevel::push(const estimator::SampleSet& set) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    const double value = set.accel[a];
    distance_[a] = std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(value)) continue;
    if (axis.seen >= settled_) distance_[a] = value - axis.mean;
    axis.seen = std::min(axis.seen + 1, memory_);
    axis.mean += (value - axis.mean) / static_cast<double>(axis.seen);
  }
  return distance_;
}

}  // namespace framewatch::daemon
