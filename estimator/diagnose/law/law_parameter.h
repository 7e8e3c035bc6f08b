// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace framewatch::estimator {

/// One parameter of an effect that is being fitted, and how a fit may change it.
struct LawParameter {
  double value = 0;  ///< as the fit uses it: the logarithm if `logarithmic`
  bool logarithmic = false;
  double step = 0;  ///< unit of the fit's unknown, about the size of a significant change
  double low = -1e300, high = 1e300;  ///< bounds of `value`
  double sigma = 0;                   ///< of a weak prior around `center`; 0: no prior
  double center = 0;
  bool free = true;  ///< false: held at its value

  /// Returns the value in the law's own unit.
  double plain() const;
};

/// Returns true if the value has reached one of its bounds.
bool at_bound(const LawParameter& parameter);

/// Returns a free parameter without bounds. Uses |step| as its step.
LawParameter linear_parameter(double value, double step);
/// Returns a free parameter that is fitted by its logarithm. value, low, high: > 0, in the law's
/// unit.
LawParameter logarithmic_parameter(double value, double low, double high);
LawParameter bounded_parameter(double value, double step, double low, double high,
                               bool free = true);
/// Returns a parameter held at this value.
LawParameter fixed_parameter(double value);

/// Families of laws that a diagnosis fits. A family covers several names of the catalog; the fitted
/// values decide between them (name_of_fit). Families with `gap` in the name are mechanical
/// clearances.
enum class LawForm {
  // restoring force over deformation and rate, at an element, between floors, or of whole frames
  power,       ///< a sgn(d) |d/D|^p
  saturating,  ///< a s(d)/s(D), s the part of a spring that softens: SaturationIndex
  hysteresis,  ///< kh z, Bouc-Wen with any sharpness and sign: HysteresisIndex
  sliders,     ///< kh z, springs in series with sliders that yield one after the other: SliderIndex
  asymptotic,  ///< kh z, a curve from every reversal toward yielding: AsymptoteIndex
  masing,      ///< kh z, round loading, doubled after every reversal: MasingIndex
  pinched,     ///< hysteresis with a slip zone around zero force
  slip_lock,   ///< hysteresis with a slip zone around zero deformation
  slack,       ///< a brace that becomes slack by its plastic deformation: SlackIndex
  peak_oriented,  ///< kh z, yielding that returns toward the largest deformation: PeakOriented
  friction,       ///< fc (1 + s exp(-(v/vs)^2)) tanh(v/v0), with presliding: FrictionIndex
  power_damping,  ///< a sgn(v) |v/V|^p
  amplitude,      ///< a ((1 - s) z(d/D) + s slip(d/D)) + b sgn(v) |v/V|^q: AmplitudeIndex
  gap_positive,   ///< contact at clearance g: max(kg (d - g) + cg v, 0) while d > g
  gap_negative,   ///< contact toward negative deformation
  gap_both,       ///< both; kg < 0 softens
  changing,       ///< dk clip((t - t0)/T, 0, 1) d, t0 and T of each record
  // at a node, linear
  mass,           ///< dm at a crossing of frames
  resonator,      ///< hidden mass on spring and dashpot
  spring,         ///< between floors
  damper,         ///< between floors
  rocking,        ///< of the base
  bending,        ///< of the frames
  modal_damping,  ///< damping ratio of one mode, in addition to the dashpots
  panels,         ///< of a floor that is declared rigid: G and damping
  // external force at a node
  harmonic,   ///< one frequency, amplitude and phase of each record
  broadband,  ///< arbitrary force
  // at an axis
  misaligned,
  swapped,  ///< two axes exchanged
  clipped,  ///< the readings of the axis are not used
};

/// Indices of the parameters of LawForm::saturating. Parameter 0 is the force at the deformation D.
///
///   s(d) = d - d / (1 + |d/d0|^m)^(1/m)
///
/// A spring that loses s is hyperbolic for m = 1, nearly a hyperbolic tangent for m = 2.5, and has
/// two slopes for large m. Far below d0, s is the power m + 1 of d. Source: Richard and Abbott, J.
/// Eng. Mech. Div. 101 (1975).
struct SaturationIndex {
  enum : std::size_t { force, d0, shape };
};

/// Indices of the parameters of LawForm::amplitude. `slip` is s above and 0 by default. z(x) is
/// sgn(x) |x|^p. With `saturation` (d0/D; 0 by default, none) it is s(x)/s(1) of SaturationIndex
/// with the shape p - 1. slip(x) is z(x) at first loading: SlipCurve.
struct AmplitudeIndex {
  enum : std::size_t { elastic, exponent, damping, damping_exponent, slip, saturation };
};

/// Returns true if the law is a force over deformations, of one element or of every element of a
/// place.
bool is_element_law(LawForm form);
/// Returns true if the law depends on past motion: hysteresis of any kind.
bool is_hysteretic(LawForm form);
/// Returns true if the law is a contact.
bool is_contact(LawForm form);

/// Parameters of an element law and its scales.
struct LawValues {
  LawForm form = LawForm::power;
  /// In the order named at the form, amplitude first. For hysteresis see HysteresisIndex.
  std::vector<double> p;
  double deformation = 1.0;  ///< D, m
  double rate = 1.0;         ///< V, m/s
  double scale = 1.0;        ///< of the force: share of one element where a place has several
};

}  // namespace framewatch::estimator
