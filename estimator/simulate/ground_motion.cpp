// SPDX-License-Identifier: MIT
#include "estimator/simulate/ground_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace {

/// Integrates x'' + 2 zeta w x' + w^2 x = input by Newmark's average acceleration, which is
/// unconditionally stable; the input is linear between samples.
class Oscillator {
 public:
  Oscillator(double frequency_hz, double damping_ratio, double step_s)
      : w_(2 * M_PI * frequency_hz), zeta_(damping_ratio), h_(step_s) {}

  void advance(double input) {
    const double x_predicted = x_ + h_ * v_ + h_ * h_ / 4 * a_;
    const double v_predicted = v_ + h_ / 2 * a_;
    a_ = (input - 2 * zeta_ * w_ * v_predicted - w_ * w_ * x_predicted) /
         (1 + zeta_ * w_ * h_ + w_ * w_ * h_ * h_ / 4);
    x_ = x_predicted + h_ * h_ / 4 * a_;
    v_ = v_predicted + h_ / 2 * a_;
  }
  /// Returns 2 zeta w x' + w^2 x, which the soil column transmits to the surface.
  double transmitted() const { return 2 * zeta_ * w_ * v_ + w_ * w_ * x_; }
  double acceleration() const { return a_; }

 private:
  double w_, zeta_, h_;
  double x_ = 0, v_ = 0, a_ = 0;
};

double envelope(const KanaiTajimi& p, double t) {
  if (t < p.build_up_s) return (t / p.build_up_s) * (t / p.build_up_s);
  if (t <= p.build_up_s + p.strong_s) return 1;
  return std::exp(-(t - p.build_up_s - p.strong_s) / p.decay_s);
}

}  // namespace

double GroundMotion::duration_s() const {
  return accel.empty() ? 0 : step_s * static_cast<double>(accel.size() - 1);
}

double GroundMotion::at(double t_s) const {
  // Times on the grid are rounded; rounding must not lose the end samples.
  constexpr double rounding = 1e-9;
  const double last = static_cast<double>(accel.size()) - 1;
  const double place = t_s / step_s;
  if (!(place >= -rounding) || place > last + rounding) return 0;
  const double within = std::clamp(place, 0.0, last);
  const auto i = static_cast<std::size_t>(within);
  const double fraction = within - static_cast<double>(i);
  if (fraction == 0) return accel[i];
  return accel[i] + fraction * (accel[i + 1] - accel[i]);
}

double GroundMotion::peak() const {
  double peak = 0;
  for (const double a : accel) peak = std::max(peak, std::abs(a));
  return peak;
}

double PlanMotion::duration_s() const {
  return std::max(x.duration_s(), y.duration_s());
}

PlanMotion directed(const GroundMotion& motion, double angle_rad) {
  PlanMotion out{motion, motion};
  for (double& a : out.x.accel) a *= std::cos(angle_rad);
  for (double& a : out.y.accel) a *= std::sin(angle_rad);
  return out;
}

GroundMotion kanai_tajimi(const KanaiTajimi& p) {
  assert(p.step_s > 0 && p.duration_s > 0 && p.decay_s > 0);
  GroundMotion motion{p.step_s, {}};
  Oscillator soil(p.ground_frequency_hz, p.ground_damping_ratio, p.step_s);
  Oscillator high_pass(p.high_pass_hz, 1.0, p.step_s);
  Random random(p.seed);
  const auto samples = static_cast<std::size_t>(std::llround(p.duration_s / p.step_s)) + 1;
  motion.accel.reserve(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double shape = envelope(p, p.step_s * static_cast<double>(i));
    soil.advance(shape * random.normal());
    high_pass.advance(soil.transmitted());
    motion.accel.push_back(high_pass.acceleration());
  }
  const double peak = motion.peak();
  if (peak > 0)
    for (double& a : motion.accel) a *= p.peak_mps2 / peak;
  return motion;
}

}  // namespace framewatch::estimator
