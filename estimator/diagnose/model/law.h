#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// Families of laws that a diagnosis fits. A family covers several names of the catalogue; the
/// fitted values decide between them (name_of_fit). Those with `gap` in the name are mechanical
/// clearances.
enum class LawForm {
  // at an element: restoring force over deformation and rate
  power,          ///< a sgn(d) |d/D|^p
  hysteresis,     ///< kh z, Bouc-Wen of any sharpness
  pinched,        ///< the same with a slip zone
  friction,       ///< fc tanh(v/v0)
  power_damping,  ///< a sgn(v) |v/V|^p
  gap_positive,   ///< contact at clearance g: kg max(d - g, 0)
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
  panels,     ///< of a floor that is declared rigid: G and damping
  // external force at a node
  harmonic,   ///< one frequency, amplitude and phase of each record
  broadband,  ///< arbitrary force
  // at an axis
  misaligned,
  swapped,  ///< two axes exchanged
  clipped,  ///< the readings of the axis are not used
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

/// An element law in time, with the internal state of hysteresis.
class LawMotion {
 public:
  explicit LawMotion(const LawValues& values) : values_(values) {}

  /// Restoring force, N, at deformation d (m), its rate v (m/s) and time t (s), after a step from
  /// the state of the last accept().
  double force(double d, double v, double t) const;
  /// Ends the step at this motion.
  void accept(double d, double v, double t);

 private:
  double advanced(double d) const;

  LawValues values_;
  double z_ = 0, d_ = 0;
};

/// Force of a law under a known motion: d, v at even steps of step_s.
Eigen::VectorXd law_force(const LawValues& values, const Eigen::VectorXd& d,
                          const Eigen::VectorXd& v, double step_s);

}  // namespace framewatch::estimator
