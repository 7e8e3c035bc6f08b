#include "estimator/diagnose/law/sliding.h"

#include <cmath>

#include "estimator/diagnose/law/hysteretic_force.h"

namespace framewatch::estimator {
namespace {

using I = FrictionIndex;

constexpr double kAtRest = 1e-6;  // of v0

/// Returns the rate, 1/s, at which z approaches its steady value.
double approach_per_s(const std::vector<double>& p, double v) {
  if (std::abs(v) < kAtRest * p[I::v0])
    return p[I::v0] / ((1 + value_or(p, I::static_ratio, 0)) * p[I::presliding]);
  return std::abs(v / steady_friction(p, v)) / p[I::presliding];
}

}  // namespace

double steady_friction(const std::vector<double>& p, double v) {
  double more = value_or(p, I::static_ratio, 0);
  if (more != 0) more *= std::exp(-(v / p[I::stribeck]) * (v / p[I::stribeck]));
  return (1 + more) * std::tanh(v / p[I::v0]);
}

/// Exact for a steady value that changes linearly and a constant rate of approach.
double sliding_z(const std::vector<double>& p, double z, double v, double v_now, double step_s) {
  const double from = steady_friction(p, v), to = steady_friction(p, v_now);
  const double passed = 0.5 * (approach_per_s(p, v) + approach_per_s(p, v_now)) * step_s;
  if (!(passed > 0)) return z;
  const double left = std::exp(-passed);
  return to - (to - from) * (1 - left) / passed + (z - from) * left;
}

}  // namespace framewatch::estimator
