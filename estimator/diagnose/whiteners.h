#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch {

/// Of every bin, the inverse of the Cholesky factor L of what noise puts into the equations,
/// L L^H = D S D^H: docs/equations.md (33). None when a bin has an equation without noise.
/// operation: D of every bin, equations x axes; noise: variances S, axes x bins; pushed: covariance
/// of forces that may be anything, equations x equations, times the mean variance of an equation;
/// or empty.
std::vector<Eigen::MatrixXcd> whiteners(const std::vector<Eigen::MatrixXcd>& operation,
                                        const Eigen::MatrixXd& noise,
                                        const Eigen::MatrixXd& pushed);

}  // namespace framewatch
