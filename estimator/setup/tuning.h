#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// What the row filters are tuned to.
struct Tuning {
  Eigen::VectorXd theta0;             ///< parameters, theta order, SI
  std::vector<double> noise_density;  ///< of every axis, m/s^2/sqrt(Hz)
  bool found_right = true;            ///< a window has confirmed it; windows are published
};

}  // namespace framewatch::estimator
