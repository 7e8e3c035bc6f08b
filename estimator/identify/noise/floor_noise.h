#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/floor_layout.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"

namespace framewatch::estimator {

/// How the sensor axes' noise enters one floor's motion and deformations.
struct FloorNoise {
  std::vector<int> axes;        ///< those that do
  Eigen::VectorXd variance;     ///< of one sample, per axis, (m/s^2)^2
  Eigen::MatrixXd motion;       ///< frames x axes
  Eigen::MatrixXd deformation;  ///< front unknowns x axes
  Eigen::MatrixXd covariance;   ///< front unknowns x front unknowns, of deformations
  std::vector<bool> damping;    ///< per unknown: multiplies a rate, not a deformation

  template <typename Archive>
  void archive(Archive& a) {
    a.finite(variance, covariance);
  }
};

/// noise_density: of every axis, m/s^2/sqrt(Hz).
FloorNoise floor_noise(const FloorLayout& layout, const Deformations& deformations,
                       const std::vector<double>& noise_density, double rate_hz, int floor);

/// Other densities for the same axes: variance and covariance anew, without allocating.
void set_noise_density(FloorNoise& noise, const std::vector<double>& density, double rate_hz);

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
