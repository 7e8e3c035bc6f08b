#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch {

/// Families of laws that a diagnosis fits. Each covers neighbouring names of the catalogue; the
/// name follows from the fitted values.
enum class LawForm {
  // at an element: restoring force over deformation and rate
  power,          ///< a sgn(d) |d/D|^p
  hysteresis,     ///< kh z, Bouc-Wen of any sharpness
  pinched,        ///< the same with a slip zone
  friction,       ///< fc tanh(v/v0)
  power_damping,  ///< a sgn(v) |v/V|^p
  gap_positive,   ///< kg max(d - g, 0)
  gap_negative,   ///< -kg max(-d - g, 0)
  gap_both,       ///< both
  changing,       ///< dk clip((t - t0)/T, 0, 1) d, t0 and T of each record
  // at a node, linear
  mass,       ///< dm at a crossing of frames
  resonator,  ///< hidden mass on spring and dashpot
  spring,     ///< between floors
  damper,     ///< between floors
  rocking,    ///< of the base
  bending,    ///< of the frames
  panels,     ///< of a floor that was believed rigid: G and damping
  // at a node, from outside
  harmonic,   ///< one frequency, amplitude and phase of each record
  broadband,  ///< any force at all
  // at an axis
  misaligned,
  swapped,  ///< two axes exchanged
  clipped,  ///< what the axis reads is not believed
};

/// Whether the law is a force at one element.
bool is_element_law(LawForm form);

/// Parameters of an element law and the scales it is written in.
struct LawValues {
  LawForm form = LawForm::power;
  std::vector<double> p;     ///< as named at the form: amplitude first
  double deformation = 1.0;  ///< D, m
  double rate = 1.0;         ///< V, m/s
};

/// An element law that goes through time: it remembers what a hysteretic force depends on.
class LawMotion {
 public:
  explicit LawMotion(const LawValues& values) : values_(values) {}

  /// Restoring force, N, if the deformation (m) is d and its rate (m/s) v at time t after a step
  /// from the state of the last accept().
  double force(double d, double v, double t) const;
  void accept(double d, double v, double t);

 private:
  double advanced(double d) const;

  LawValues values_;
  double z_ = 0, d_ = 0;
};

/// Of a motion that is known: d and v at even steps.
Eigen::VectorXd law_force(const LawValues& values, const Eigen::VectorXd& d,
                          const Eigen::VectorXd& v, double step_s);

}  // namespace framewatch
