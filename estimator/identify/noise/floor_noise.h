// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/floor_layout.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"

namespace framewatch::estimator {

/// The noise of the sensor axes in one floor's motion and deformations.
struct FloorNoise {
  std::vector<int> axes;        ///< axes whose noise enters
  Eigen::VectorXd variance;     ///< variance of one sample of each axis, (m/s^2)^2
  Eigen::MatrixXd motion;       ///< frames x axes
  Eigen::MatrixXd deformation;  ///< front unknowns x axes
  Eigen::MatrixXd covariance;   ///< covariance of the deformations, front unknowns x front unknowns
  std::vector<bool> damping;    ///< by unknown: multiplies a rate, not a deformation

  void archive(auto& a) { a.finite(variance, covariance); }
};

/// Returns the noise of a floor. noise_density: of every axis, m/s^2/sqrt(Hz).
FloorNoise floor_noise(const FloorLayout& layout, const Deformations& deformations,
                       const std::vector<double>& noise_density, double rate_hz, int floor);

/// Updates variance and covariance for other densities of the same axes, without allocating.
void set_noise_density(FloorNoise& noise, const std::vector<double>& density, double rate_hz);

/// Returns the response of the high-pass and one tap set to a unit impulse. `length` covers the
/// decay of the high-pass.
std::vector<double> impulse_response(const std::vector<double>& taps, const HighPass& high_pass,
                                     std::size_t length);

/// Second moments of a regressor filter's outputs for white acceleration noise of variance 1: g00 =
/// var p, g11 = var p', g22 = var p'', g20 = cov(p'', p). docs/equations.md (14).
struct NoiseMoments {
  double g00 = 0, g11 = 0, g22 = 0, g20 = 0;
};

/// Filters white noise through high-pass, derivative triple and an oscillator section.
class NoiseFilter {
 public:
  /// length: number of instants in which the high-pass decays.
  NoiseFilter(const DerivativeTriple& triple, const HighPass& high_pass, std::size_t length);

  NoiseMoments through(const OscillatorSection& section) const;

 private:
  std::vector<std::vector<double>> impulse_;  ///< responses of p, p', p'' to a unit impulse
};

}  // namespace framewatch::estimator
