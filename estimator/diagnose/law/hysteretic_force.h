#pragma once

#include <vector>

#include "estimator/diagnose/law/law_values.h"

namespace framewatch::estimator {

/// Indices of the parameters of LawForm::hysteresis, pinched and slip_lock; those after kOwn may be
/// missing, they are 0 then (`loading`: 1).
///
///   z' = v h/(1 + stiffness_loss e) (1 - (1 + strength_loss e) |z|^n (beta sgn(v z) + loading -
///   beta)), z and deformation in units of dy, e the work of z
///
/// loading > 0: z ends at (1 / loading)^(1/n); < 0: it hardens. Pinched: h = 1 - slip (1 -
/// exp(-e/slip_work)) exp(-((z sgn(v) - offset) / width)^2), slip_work 0: at once. Slip-lock: the
/// same with d/dy in place of z, without offset. Sources: Wen 1976; Baber and Noori 1985; Foliente
/// 1995.
struct HysteresisIndex {
  enum : std::size_t { kh, dy, exponent, beta, kOwn };
  enum : std::size_t { strength_loss = kOwn, stiffness_loss, loading, kHysteresis };
  enum : std::size_t { slip = kOwn, width, offset, slip_work, pinched_strength, pinched_stiffness };
};

/// Indices of the parameters of LawForm::sliders: kh springs in series with sliders that give way
/// at deformations spread evenly over dy (1 +- spread). `loss`: of their strength with the work
/// done, as above; may be missing.
struct SliderIndex {
  enum : std::size_t { kh, dy, spread, loss };
  static constexpr int kCount = 10;
};

/// Indices of the parameters of LawForm::asymptotic: from every reversal (d_r, z_r) on
///   z = z_r + (s - z_r) x / (1 + x^R)^(1/R), x = (d - d_r) / ((s - z_r) dy), s the direction,
/// R = R0 (1 - loss q / (0.15 + q)), q how far the largest deformation on that side was beyond the
/// point x = 1, in units of dy. Source: Menegotto and Pinto 1973.
struct AsymptoteIndex {
  enum : std::size_t { kh, dy, sharpness, loss };
};

/// Spread of sliders that yield about as roundly as a curve of that sharpness.
double spread_like(double sharpness);

/// The memory of such a law that has not moved yet.
std::vector<double> no_reversal(const LawValues& values);
/// z after a step from (z, d) to d_now.
double asymptotic_z(const LawValues& values, const std::vector<double>& memory, double z, double d,
                    double d_now);
/// Ends that step.
void turn(std::vector<double>& memory, double z, double d, double d_now);

/// x^p, x >= 0; quick for small whole p.
double power_of(double x, double p);

/// Parameter `index`, or `without` where a law has fewer.
double value_or(const std::vector<double>& p, std::size_t index, double without);

/// What the work done makes of a law of hysteresis: it changes once a step.
struct WornShape {
  double weaker = 1, softer = 1;  ///< factors on strength and flexibility
  double slip = 0;                ///< depth of the slip zone
  double most = 0;                ///< largest |z|
};
WornShape worn_shape(const LawValues& values, double work);

/// z of a hysteretic law at the end of a step from one state, to one end after another.
class HystereticStep {
 public:
  /// The step begins at (z, d).
  void begin(const WornShape& shape, double z, double d);
  double end(const LawValues& values, double d_now);

 private:
  /// Slope dz/dd at the step's begin, in units of dy.
  struct Begin {
    bool known = false;
    double rising, slope;  ///< without and with the slip zone
  };

  WornShape shape_;
  double z_ = 0, d_ = 0;
  Begin up_, down_;
};

/// Force of the sliders at d, over kh; `at` are their positions, SliderIndex::kCount of them.
double slider_force(const LawValues& values, const std::vector<double>& at, double d, double work);
/// Moves them after a step that ends at d.
void move_sliders(const LawValues& values, std::vector<double>& at, double d, double work);

}  // namespace framewatch::estimator
