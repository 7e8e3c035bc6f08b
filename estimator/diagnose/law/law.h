#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/law/law_values.h"
#include "estimator/diagnose/law/slip_curve.h"

namespace framewatch::estimator {

/// Evaluates one element law over time. Holds the internal state of hysteresis.
class LawMotion {
 public:
  explicit LawMotion(const LawValues& values);

  /// Returns the restoring force, N, at deformation d (m), rate v (m/s) and time t (s), after a
  /// step from the state at the last accept().
  double force(double d, double v, double t);
  /// Ends the step at this motion.
  void accept(double d, double v, double t);

 private:
  double plain_force(double d, double v, double t);
  /// Returns z of LawForm::amplitude at d/D.
  double amplitude_z(double x) const;
  /// Returns z of a hysteretic law at d. Caches the last one because a step ends where its force
  /// was evaluated.
  double next_z(double d);

  LawValues values_;
  double z_ = 0, d_ = 0, v_ = 0, t_ = 0, work_ = 0;
  bool wears_ = false;  ///< its shape changes with the work done
  WornShape shape_;
  HystereticStep step_;
  bool has_next_ = false;
  double next_d_ = 0, next_z_ = 0;
  std::vector<double> memory_;  ///< positions of sliders, last reversal, or slack
  std::optional<SlipCurve> slip_;
};

/// Returns the force of a law, N, under a known motion. d, v: deformation (m) and rate (m/s) at
/// steps of step_s.
Eigen::VectorXd law_force(const LawValues& values, const Eigen::VectorXd& d,
                          const Eigen::VectorXd& v, double step_s);

}  // namespace framewatch::estimator
