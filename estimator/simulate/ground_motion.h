// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace framewatch::estimator {

/// Ground acceleration along one direction, piecewise linear between samples step_s apart.
struct GroundMotion {
  double step_s = 0.01;
  std::vector<double> accel;  ///< m/s^2, first sample at time 0

  double duration_s() const;
  /// Returns the acceleration at time t, m/s^2; 0 before the first and after the last sample.
  double at(double t_s) const;
  /// Returns the largest |accel|, m/s^2.
  double peak() const;
};

/// Ground acceleration along both axes of the plan.
struct PlanMotion {
  GroundMotion x;
  GroundMotion y;

  double duration_s() const;
};

/// Returns a motion that arrives at an angle to the x axis: x component times cos, y component
/// times sin.
PlanMotion directed(const GroundMotion& motion, double angle_rad);

/// Parameters of a stationary white noise filtered by the ground's resonance (Kanai-Tajimi) and a
/// second-order high-pass against drift, times an envelope: quadratic build-up, strong part,
/// exponential decay.
struct KanaiTajimi {
  double ground_frequency_hz = 2.5;
  double ground_damping_ratio = 0.6;
  double high_pass_hz = 0.2;
  double peak_mps2 = 2.0;  ///< the motion is scaled to this peak
  double duration_s = 30;
  double build_up_s = 2;  ///< envelope (t / build_up)^2 until here
  double strong_s = 20;   ///< envelope 1 for this long
  double decay_s = 10;    ///< then exp(-t / decay)
  double step_s = 0.01;
  std::uint64_t seed = 1;
};

/// Returns the motion of the parameters, identical on every machine.
GroundMotion kanai_tajimi(const KanaiTajimi& parameters);

}  // namespace framewatch::estimator
