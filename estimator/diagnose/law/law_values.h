#pragma once

#include <cstddef>
#include <vector>

namespace framewatch::estimator {

/// Families of laws that a diagnosis fits. A family covers several names of the catalogue; the
/// fitted values decide between them (name_of_fit). Those with `gap` in the name are mechanical
/// clearances.
enum class LawForm {
  // restoring force over deformation and rate, at an element, between floors, or of whole frames
  power,          ///< a sgn(d) |d/D|^p
  saturating,     ///< a d0 tanh(d/d0)
  hysteresis,     ///< kh z, Bouc-Wen of any sharpness and sign: hysteretic_force.h
  sliders,        ///< kh z, springs in series with sliders that give way one after the other
  asymptotic,     ///< kh z, a curve from every reversal toward yielding: hysteretic_force.h
  pinched,        ///< hysteresis with a slip zone about zero force
  slip_lock,      ///< hysteresis with a slip zone about zero deformation
  slack,          ///< a brace that is slack by what it has yielded: slack.h
  friction,       ///< fc (1 + s exp(-(v/vs)^2)) tanh(v/v0), with presliding: sliding.h
  power_damping,  ///< a sgn(v) |v/V|^p
  amplitude,      ///< a ((1 - s) sgn(d) |d/D|^p + s slip(d/D)) + b sgn(v) |v/V|^q: slip_curve.h
  gap_positive,   ///< contact at clearance g: max(kg (d - g) + cg v, 0) while d > g
  gap_negative,   ///< the same toward negative deformation
  gap_both,       ///< both; kg < 0 softens
  changing,       ///< dk clip((t - t0)/T, 0, 1) d, t0 and T of each record
  // at a node, linear
  mass,           ///< dm at a crossing of frames
  resonator,      ///< hidden mass on spring and dashpot
  spring,         ///< between floors
  damper,         ///< between floors
  rocking,        ///< of the base
  bending,        ///< of the frames
  modal_damping,  ///< ratio of one mode, beside the dashpots'
  panels,         ///< of a floor that is declared rigid: G and damping
  // external force at a node
  harmonic,   ///< one frequency, amplitude and phase of each record
  broadband,  ///< arbitrary force
  // at an axis
  misaligned,
  swapped,  ///< two axes exchanged
  clipped,  ///< the readings of the axis are not used
};

/// Indices of the parameters of LawForm::amplitude. `slip` is s above, 0 where it is missing.
struct AmplitudeIndex {
  enum : std::size_t { elastic, exponent, damping, damping_exponent, slip };
};

/// Whether the law is a force over deformations: of one element, or of every one of a place.
bool is_element_law(LawForm form);
/// Whether it remembers its past: hysteresis of any kind.
bool is_hysteretic(LawForm form);
/// Whether it is a contact.
bool is_contact(LawForm form);

/// Parameters of an element law and the scales it is written in.
struct LawValues {
  LawForm form = LawForm::power;
  /// As named at the form: amplitude first. Those of hysteresis: hysteretic_force.h.
  std::vector<double> p;
  double deformation = 1.0;  ///< D, m
  double rate = 1.0;         ///< V, m/s
  double scale = 1.0;        ///< of the force: share of one element where a place has several
};

}  // namespace framewatch::estimator
