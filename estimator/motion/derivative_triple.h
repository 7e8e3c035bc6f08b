// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace framewatch::estimator {

/// Three finite impulse responses of equal length and delay that output p, p' and p'' of their
/// input. Taps are newest first, in units of 1, 1/s, 1/s^2; delay is in samples.
struct DerivativeTriple {
  std::vector<double> value;
  std::vector<double> first;
  std::vector<double> second;
  double delay = 0;
  /// Variants of `first` and `second` for the input of a simulation that takes its input as linear
  /// between samples. They undo the attenuation of that hold, sinc^2 of half the frequency. Empty
  /// if not requested.
  std::vector<double> held_first = {};
  std::vector<double> held_second = {};
  int length() const { return static_cast<int>(value.size()); }
};

/// Returns 13 taps fitted by least squares on 0..rate/4, exact at rest, times the numerator (1 +
/// z^-1)^2 / 4 of the oscillator sections: 15 taps in all. The relative error is below 1e-4 up to
/// rate/5. advance: the outputs belong to an instant this many samples later than `delay` says, at
/// most half a sample either way; it undoes a sensor's known delay. Source: docs/equations.md,
/// derivative triple.
DerivativeTriple matched_triple(double rate_hz, double advance = 0);

/// Returns matched_triple() with held_first and held_second.
DerivativeTriple held_triple(double rate_hz, double advance = 0);

/// Returns the triple of the trapezoidal rule, times the same numerator: p'' is the integrand, p'
/// and p are its first and second trapezoidal integrals. The paper integrates this way.
DerivativeTriple trapezoid_triple(double rate_hz);

/// The second-order section that integrates acceleration twice without drift:
///
///   w^2 / (s^2 + 2 zeta w s + w^2),   w = 2 pi corner.
///
/// Its output is the displacement of a damped oscillator under that acceleration, times w^2. Above
/// the corner it is a double integrator, w^2 / s^2. Below the corner its gain is 1 and nothing
/// accumulates: a slow sensor error stays bounded and is forgotten after a few periods of the
/// corner.
///
/// Applied to p = P a, p' and p'' (DriftControlledIntegrator), it gives w^2 times displacement,
/// velocity and acceleration, all behind the same filter P s^2 / (s^2 + 2 zeta w s + w^2). So the
/// equation of motion holds between them exactly, for any corner and damping. To integrate first
/// and high-pass velocity and displacement afterwards would filter the three differently. A
/// second-order high-pass at a tenth of a mode's frequency shifts its phase by 0.14 rad, which is 7
/// % of critical damping. docs/equations.md (8), (12).
///
/// The transform is bilinear, with a prewarped corner. All sections share the numerator (1 +
/// z^-1)^2 / 4, which is part of the derivative triple (matched_triple). The recursion remains:
///
///   s[t] = gain x[t] - a1 s[t-1] - a2 s[t-2].
struct OscillatorSection {
  /// corner_hz: above 0 and below rate_hz / 2. damping: zeta > 0, a ratio to critical damping.
  OscillatorSection(double corner_hz, double damping, double rate_hz);
  double gain, a1, a2;
};

}  // namespace framewatch::estimator
