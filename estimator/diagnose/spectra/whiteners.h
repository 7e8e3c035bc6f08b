#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/spectra/whitener.h"

namespace framewatch::estimator {

/// Returns the inverse of the Cholesky factor L of the equations' noise covariance in every bin, L
/// L^H = D S D^H: docs/equations.md (33). Returns an empty list if a bin has an equation without
/// noise. `operation`: D of every bin, equations x axes. `noise`: variances S, axes x bins.
/// `pushed`: covariance of arbitrary forces, equations x equations, in units of the mean variance
/// of an equation; may be empty.
std::vector<Whitener> whiteners(const std::function<Eigen::MatrixXcd(Eigen::Index)>& operation,
                                const Eigen::MatrixXd& noise, const Eigen::MatrixXd& pushed);

/// Orthonormal basis of the motions that no axis reads (unread) and of its complement (read):
/// equations x motions.
struct ReadMotions {
  Eigen::MatrixXd read, unread;
};

/// Returns the whiteners if the last columns D_u of the operation belong to motions that no axis
/// reads. Eliminates them by Z' = read' - (read' D_u) (unread' D_u)^-1 unread': Z' D_u = 0. The
/// whiteners are L^-1 Z', L L^H = Z' D S D^H Z*, with rows of zeros below, up to the number of
/// equations. Source: docs/equations.md (49), (50).
std::vector<Whitener> whiteners(const std::function<Eigen::MatrixXcd(Eigen::Index)>& operation,
                                const Eigen::MatrixXd& noise, const Eigen::MatrixXd& pushed,
                                const ReadMotions& motions);

}  // namespace framewatch::estimator
