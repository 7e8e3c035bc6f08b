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

}  // namespace framewatch::estimator
