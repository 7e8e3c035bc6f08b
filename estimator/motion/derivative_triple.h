#pragma once

#include <vector>

namespace framewatch::estimator {

/// Three finite impulse responses of equal length and equal delay whose outputs are p, p' and p''
/// of their input. Taps newest first; units 1, 1/s, 1/s^2. delay is in samples.
struct DerivativeTriple {
  std::vector<double> value;
  std::vector<double> first;
  std::vector<double> second;
  double delay = 0;
  /// As first and second, for the input of a simulation that takes it as linear between samples:
  /// what that takes off, sinc^2 of half the frequency, is put on. Empty where nobody asks for
  /// them.
  std::vector<double> held_first = {};
  std::vector<double> held_second = {};
  int length() const { return static_cast<int>(value.size()); }
};

/// Least squares on 0..rate/4 with exact behaviour at rest, 13 taps, followed by the numerator
/// (1 + z^-1)^2 / 4 of the oscillator sections (15 taps in all). Relative error below 1e-4 up to
/// rate/5. advance: outputs belong to an instant this many samples later than `delay` says, at most
/// half a sample either way; it undoes a sensor's known delay. Source: docs/equations.md,
/// derivative triple.
DerivativeTriple matched_triple(double rate_hz, double advance = 0);

/// matched_triple() with held_first and held_second.
DerivativeTriple held_triple(double rate_hz, double advance = 0);

/// What the trapezoidal rule implies, times the same numerator: p'' = integrand, p' and p its first
/// and second trapezoidal integrals. The paper's integration.
DerivativeTriple trapezoid_triple(double rate_hz);

/// The second-order section that integrates acceleration twice without drift,
///
///   w^2 / (s^2 + 2 zeta w s + w^2),   w = 2 pi corner,
///
/// the displacement of a damped oscillator under that acceleration, times w^2. Above the corner it
/// is w^2 / s^2, a double integrator. Below it the gain is 1 and nothing accumulates: a slow error
/// of the sensor stays bounded and is forgotten after a few periods of the corner.
///
/// Applied to p = P a, p' and p'' (DriftControlledIntegrator) it gives w^2 times displacement,
/// velocity and acceleration, all three behind the same filter P s^2 / (s^2 + 2 zeta w s + w^2).
/// So the equation of motion holds between them exactly, whatever corner and damping are.
/// Integrating first and high-passing velocity and displacement afterwards gives each of the three
/// a filter of its own: a second-order high-pass a tenth of a mode's frequency turns its phase by
/// 0.14 rad, which is 7 % of critical damping. docs/equations.md (8), (12).
///
/// Bilinear transform, corner prewarped. The numerator (1 + z^-1)^2 / 4 is common to all sections
/// and part of the derivative triple (matched_triple); what remains is the recursion
///
///   s[t] = gain x[t] - a1 s[t-1] - a2 s[t-2].
struct OscillatorSection {
  /// 0 < corner_hz < rate_hz / 2; damping: zeta > 0, a ratio to critical.
  OscillatorSection(double corner_hz, double damping, double rate_hz);
  double gain, a1, a2;
};

}  // namespace framewatch::estimator
