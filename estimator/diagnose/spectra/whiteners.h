#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// Inverse of the Cholesky factor L of the equations' noise covariance in every bin,
/// L L^H = D S D^H: docs/equations.md (33). Empty when a bin has an equation without noise.
/// operation: D of every bin, equations x axes; noise: variances S, axes x bins; pushed: covariance
/// of arbitrary forces, equations x equations, in units of the mean variance of an equation; or
/// empty.
std::vector<Eigen::MatrixXcd> whiteners(
    const std::function<Eigen::MatrixXcd(Eigen::Index)>& operation, const Eigen::MatrixXd& noise,
    const Eigen::MatrixXd& pushed);

}  // namespace framewatch::estimator
