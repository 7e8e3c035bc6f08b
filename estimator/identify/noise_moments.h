#pragma once

#include <vector>

#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/motion_filter.h"

namespace framewatch {

/// Second moments of p, p', p'' of a row filter's output when its input is white noise of variance
/// 1: var p, var p', var p'', cov(p'', p).
struct NoiseMoments {
  double g00 = 0, g11 = 0, g22 = 0, g20 = 0;
};

/// White noise through high-pass, derivative triple and a row's all-pole low-pass.
class NoiseFilter {
 public:
  /// length: instants after which the high-pass has decayed.
  NoiseFilter(const DerivativeTriple& triple, const HighPass& high_pass, std::size_t length);

  /// Of s = gain x - a1 s' - a2 s''.
  NoiseMoments through(double gain, double a1, double a2) const;

 private:
  std::vector<std::vector<double>> impulse_;  ///< response of p, p', p'' to a unit impulse
};

}  // namespace framewatch
