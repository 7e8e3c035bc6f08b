// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/linear_building.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"

namespace framewatch::test {

/// A building on ground that moves all the time, for any duration. In both directions the ground
/// is white noise through its resonance and a low-pass, in half steps of the samples. It is linear
/// between steps, and the building's response to it is exact. Not the estimator's scheme.
class RestlessBuilding {
 public:
  static constexpr double kRate_hz = 100;

  /// axes: the measured ones, in any order.
  RestlessBuilding(const estimator::Structure& structure, const Eigen::VectorXd& theta,
                   const std::vector<estimator::SensorAxis>& axes, std::uint64_t seed);

  /// Takes time to compute; do not call it for every instant.
  void set_theta(const Eigen::VectorXd& theta) { building_.set_theta(theta); }
  /// One-sided density of the ground's acceleration at its resonance, m/s^2/sqrt(Hz).
  void set_ground(double density) { ground_density_ = density; }
  /// Of every axis, one-sided, m/s^2/sqrt(Hz).
  void set_noise(double density) { noise_density_ = density; }

  /// Returns the measurements of the axes at the next instant, m/s^2.
  const Eigen::VectorXd& next();

 private:
  struct Section {  ///< of second order, direct form II transposed
    double b0, b1, b2, a1, a2;
    double s1[2] = {0, 0}, s2[2] = {0, 0};
    double through(double x, int direction);
  };
  Eigen::Vector2d ground();

  estimator::LinearBuilding building_;
  estimator::Random random_;
  std::vector<Section> sections_;
  Eigen::Vector2d before_ = Eigen::Vector2d::Zero();
  double ground_density_ = 0, noise_density_ = 0;
  std::vector<Eigen::Index> sensed_;  ///< degree of freedom; base x and base y follow behind
  Eigen::VectorXd measured_;
};

}  // namespace framewatch::test
