// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "estimator/diagnose/law/law_parameter.h"

namespace framewatch::estimator {

/// Indices of the parameters of LawForm::hysteresis, pinched and slip_lock. Parameters from kOwn on
/// are optional. Their default is 0, for `loading` 1.
///
///   z' = v h/(1 + stiffness_loss e) (1 - (1 + strength_loss e) |z|^n (beta sgn(v z) + loading -
///   beta)), z and deformation in units of dy, e the work of z
///
/// If loading > 0, z approaches (1 / loading)^(1/n). If loading < 0, the law hardens. For pinched,
/// h = 1 - slip (1 - exp(-e/slip_work)) exp(-((z sgn(v) - offset) / width)^2); slip_work = 0 means
/// the full slip from the start. Slip_lock uses d/dy instead of z and has no offset. Sources: Wen
/// 1976; Baber and Noori 1985; Foliente 1995.
struct HysteresisIndex {
  enum : std::size_t { kh, dy, exponent, beta, kOwn };
  enum : std::size_t { strength_loss = kOwn, stiffness_loss, loading, kHysteresis };
  enum : std::size_t { slip = kOwn, width, offset, slip_work, pinched_strength, pinched_stiffness };
};

/// Exponent of hysteresis above which its corner is sharp: it is computed and named as bilinear.
inline constexpr double kSharpCorner = 20;
/// Exponent of a hysteresis that is bilinear.
inline constexpr double kBilinear = 40;

/// Indices of the parameters of LawForm::sliders: springs of total stiffness kh in series with
/// sliders. The sliders yield at deformations spread evenly over dy (1 +- spread), toward positive
/// deformation at 1 + asymmetry times, toward negative at 1 - asymmetry times that. `loss` and
/// `asymmetry` are optional. `loss` reduces their strength with the work done, like strength_loss
/// above.
struct SliderIndex {
  enum : std::size_t { kh, dy, spread, loss, asymmetry };
  static constexpr int kCount = 10;
};

/// Indices of the parameters of LawForm::asymptotic. From every reversal (d_r, z_r) on, the law
/// follows
///
///   z = z_r + (s - z_r) x / (1 + x^R)^(1/R), x = (d - d_r) / ((s - z_r) dy), s the direction,
///   R = R0 (1 - loss q / (0.15 + q)),
///
/// where q is how far the largest deformation on that side exceeded the point x = 1, in units of
/// dy. Source: Menegotto and Pinto 1973.
struct AsymptoteIndex {
  enum : std::size_t { kh, dy, sharpness, loss };
};

/// Indices of the parameters of LawForm::masing. At first loading
///
///   z = d / (1 + |d/dy|^n)^(1/n), n the sharpness
///
/// and after reversals this curve doubled (SlipCurve). Soil that is hyperbolic has n = 1. Sources:
/// Masing 1926; Kondner 1963; Richard and Abbott 1975.
struct MasingIndex {
  enum : std::size_t { kh, dy, sharpness };
};

/// Indices of the parameters of LawForm::peak_oriented: concrete that cracks and yields.
struct PeakIndex {
  enum : std::size_t { kh, dy, unloading };
};

/// Yielding whose force returns toward the largest deformation so far. In units of dy, z rises to 1
/// at the largest deformation P so far on its side, at least 1, and stays there beyond. Unloading
/// has the slope P^-unloading down to z = 0; from there a straight line leads to the largest
/// deformation of the other side. A cycle that turns before z = 0 returns on its own line first.
/// Sources: Clough and Johnston 1966 (unloading 0); Takeda, Sozen and Nielsen, J. Struct. Div. 96
/// (1970); Mahin and Bertero, J. Struct. Div. 102 (1976).
class PeakOriented {
 public:
  /// Starts at rest. unloading: 0 to 1.
  explicit PeakOriented(double unloading) : unloading_(unloading) {}

  /// Returns z after a step from the current deformation to x.
  double at(double x) const;
  /// Ends the step at x.
  void move(double x);

 private:
  /// One side, with deformation and z positive toward it.
  struct Side {
    double peak = 1;
    bool turned = false;  ///< unloading began at `x`, `z` and has not reached z = 0
    double x = 0, z = 0;
  };
  Side& side(double direction) { return sides_[direction > 0 ? 0 : 1]; }
  const Side& side(double direction) const { return sides_[direction > 0 ? 0 : 1]; }
  double unloading_slope(const Side& side) const;

  double unloading_, x_ = 0, z_ = 0;
  std::array<Side, 2> sides_;
};

/// Returns the spread of sliders that yield about as gradually as an asymptotic law with this
/// sharpness.
double spread_like(double sharpness);

/// Returns the memory of an asymptotic law that has not moved yet.
std::vector<double> no_reversal(const LawValues& values);
/// Returns z of an asymptotic law after a step from (z, d) to d_now.
double asymptotic_z(const LawValues& values, const std::vector<double>& memory, double z, double d,
                    double d_now);
/// Updates the memory after that step.
void turn(std::vector<double>& memory, double z, double d, double d_now);

/// Returns x / (1 + x^sharpness)^(1/sharpness), which approaches 1. x: >= 0.
double bent(double x, double sharpness);

/// Returns x^p for x >= 0. Fast for p = 1, 2 and 3.
double power_of(double x, double p);

/// Returns parameter `index`, or `without` if the law has fewer parameters.
double value_or(const std::vector<double>& p, std::size_t index, double without);

/// Shape of a hysteretic law after some work. It is constant within a step.
struct WornShape {
  double weaker = 1, softer = 1;  ///< factors on strength and flexibility
  double slip = 0;                ///< depth of the slip zone
  double most = 0;                ///< largest |z|
};
WornShape worn_shape(const LawValues& values, double work);

/// Computes z of a hysteretic law at the end of a step. One step can be evaluated for several ends.
class HystereticStep {
 public:
  /// Starts a step at (z, d).
  void begin(const WornShape& shape, double z, double d);
  double end(const LawValues& values, double d_now);

 private:
  /// Slope dz/dd at the start of the step, in units of dy.
  struct Begin {
    bool known = false;
    double rising, slope;  ///< without and with the slip zone
  };

  WornShape shape_;
  double z_ = 0, d_ = 0;
  Begin up_, down_;
};

/// Returns the force of the sliders at deformation d, over kh. at: their positions,
/// SliderIndex::kCount.
double slider_force(const LawValues& values, const std::vector<double>& at, double d, double work);
/// Moves the sliders after a step that ends at d.
void move_sliders(const LawValues& values, std::vector<double>& at, double d, double work);

}  // namespace framewatch::estimator
