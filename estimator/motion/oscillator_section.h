#pragma once

namespace framewatch::estimator {

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
