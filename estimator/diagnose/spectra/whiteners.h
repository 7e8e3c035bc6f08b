// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// The matrix that whitens the equations of one bin. Stores only the triangle of a large lower
/// triangular matrix, because whiteners take most of a tall building's memory.
class Whitener {
 public:
  explicit Whitener(Eigen::MatrixXcd whole);

  Eigen::Index equations() const { return equations_; }
  /// Returns the whitened rows of forces on the equations.
  Eigen::VectorXcd times(const Eigen::Ref<const Eigen::VectorXcd>& forces) const;
  /// Returns whitener^H rows.
  Eigen::VectorXcd adjoint_times(const Eigen::Ref<const Eigen::VectorXcd>& rows) const;
  /// Returns whitener^H whitener.
  Eigen::MatrixXcd metric() const;
  Eigen::MatrixXcd whole() const;
  /// Returns the sum of the squares of its numbers.
  double squared_norm() const;
  bool is_finite() const;

 private:
  /// Returns column j of the triangle, from the diagonal on.
  Eigen::Map<const Eigen::VectorXcd> column(Eigen::Index j) const;

  Eigen::Index equations_;
  Eigen::MatrixXcd whole_;     ///< empty if only the triangle is stored
  Eigen::VectorXcd triangle_;  ///< column after column
};

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
