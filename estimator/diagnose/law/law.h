// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/law/law_parameter.h"

namespace framewatch::estimator {

/// The part of a spring's force that softens, 1 at x = 1: a power of x, or a part that levels off
/// (SaturationIndex).
class Softening {
 public:
  /// exponent: above 0. saturation: d0; 0: a power.
  explicit Softening(double exponent, double saturation = 0);

  /// x: of any sign.
  double at(double x) const;

 private:
  double exponent_, saturation_, size_ = 1;
};

/// Force of joints that slip a little at any motion: z(x) of a Softening at first loading. From
/// every reversal (x_r, z_r) on,
///
///   z = z_r + 2 z((x - x_r) / 2)
///
/// until its loop closes; then along the curve that the loop left. Sources: Masing 1926; Iwan, J.
/// Appl. Mech. 33 (1966); Segalman, J. Appl. Mech. 72 (2005).
class SlipCurve {
 public:
  /// Starts at rest.
  explicit SlipCurve(const Softening& first) : first_(first) {}

  /// Returns z after a step from the current position to x.
  double at(double x) const { return follow(x).z; }
  /// Ends the step at x.
  void move(double x);

 private:
  struct Point {
    double x, z;
  };
  /// End of a step. `open` counts the reversals whose loops are still open there, including one at
  /// the start of the step.
  struct End {
    std::size_t open;
    double z;
  };
  End follow(double x) const;

  Softening first_;
  std::vector<Point> reversals_;  ///< of the open loops, the outermost first
  Point now_{0, 0};
  double direction_ = 0;
};

/// Indices of the parameters of LawForm::friction. Parameters after v0 are optional. `presliding`
/// is the deformation at which a spring of constant stiffness fc / presliding would reach fc; 0
/// means no presliding. With presliding the force is fc z,
///
///   z' = (v - |v| z / g(|v|)) / presliding, g(v) = (1 + s exp(-(v/vs)^2)) tanh(v/v0)
///
/// which approaches z = g(v) in steady motion. Source: Canudas de Wit, Olsson, Astrom and
/// Lischinsky, IEEE Trans. Automatic Control 40 (1995).
struct FrictionIndex {
  enum : std::size_t { fc, v0, static_ratio, stribeck, presliding };
};

/// Returns the steady force over fc at the velocity v, with the sign of v.
double steady_friction(const std::vector<double>& p, double v);
/// Returns z after a step of step_s from (z, v) to the velocity v_now.
double sliding_z(const std::vector<double>& p, double z, double v, double v_now, double step_s);

/// Indices of the parameters of LawForm::slack: a brace that yields in both directions and stays
/// slack by its plastic deformation,
///
///   f = kh (clip(d - u, 0, dy) - clip(-d - w, 0, dy)), u = max(play, largest d so far - dy),
///
/// and w likewise for -d. Source: Tremblay and Filiatrault, Earthquake Eng. Struct. Dyn. 25 (1996);
/// OpenSees' ElasticPPGap with damage.
struct SlackIndex {
  enum : std::size_t { kh, dy, play };
};

/// Returns the slack toward positive and toward negative deformation, m, of a brace that has not
/// moved yet.
std::vector<double> first_slack(const std::vector<double>& p);
/// Returns the force over kh at deformation d.
double slack_force(const std::vector<double>& p, const std::vector<double>& slack, double d);
/// Updates the slack after a step that ends at d.
void slacken(const std::vector<double>& p, std::vector<double>& slack, double d);

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
  /// Returns the elastic and the slipping part of LawForm::amplitude at d/D.
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
  std::optional<Softening> softening_;
  std::optional<SlipCurve> slip_;
  std::optional<PeakOriented> peaks_;
  double slip_unit_m_ = 1;  ///< deformation that is 1 of slip_
};

/// Returns the force of a law, N, under a known motion. d, v: deformation (m) and rate (m/s) at
/// steps of step_s.
Eigen::VectorXd law_force(const LawValues& values, const Eigen::VectorXd& d,
                          const Eigen::VectorXd& v, double step_s);

}  // namespace framewatch::estimator
