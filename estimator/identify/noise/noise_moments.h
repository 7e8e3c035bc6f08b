#pragma once

#include <vector>

#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/motion/oscillator_section.h"

namespace framewatch::estimator {

/// Second moments of a regressor filter's outputs when the acceleration is white noise of variance
/// 1: g00 = var p, g11 = var p', g22 = var p'', g20 = cov(p'', p). docs/equations.md (14).
struct NoiseMoments {
  double g00 = 0, g11 = 0, g22 = 0, g20 = 0;
};

/// White noise through high-pass, derivative triple and an oscillator section.
class NoiseFilter {
 public:
  /// length: instants after which the high-pass has decayed.
  NoiseFilter(const DerivativeTriple& triple, const HighPass& high_pass, std::size_t length);

  NoiseMoments through(const OscillatorSection& section) const;

 private:
  std::vector<std::vector<double>> impulse_;  ///< response of p, p', p'' to a unit impulse
};

}  // namespace framewatch::estimator
