// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace framewatch::estimator {

/// The force that an effect adds to k d + c v of one element: a restoring force, N, positive when
/// it acts against positive deformation d, m; v = d', m/s. Internal states, if any, start at 0.
class ElementLaw {
 public:
  virtual ~ElementLaw() = default;
  virtual int states() const { return 0; }
  virtual double force(double time_s, double d, double v, std::span<const double> z) const = 0;
  /// Computes z' of the internal states.
  virtual void rates(double /*d*/, double /*v*/, std::span<const double> /*z*/,
                     std::span<double> /*z_rate*/) const {}
  /// Called before every step from time_s, where the deformation is d, to update the memory.
  virtual void begin_step(double /*time_s*/, double /*d*/) {}
  /// Return and restore what begin_step() keeps from step to step. One 0 without memory, because
  /// state files hold a value for every law.
  virtual std::vector<double> memory() const { return {0.0}; }
  virtual void remember(std::span<const double> /*memory*/) {}
  /// Return bounds of abs(df/dd), N/m, and abs(df/dv), N*s/m, for moderate abs(d) and abs(v); they
  /// determine the step.
  virtual double stiffness_bound() const { return 0; }
  virtual double damping_bound() const { return 0; }
};

}  // namespace framewatch::estimator
