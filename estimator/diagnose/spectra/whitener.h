#pragma once

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

}  // namespace framewatch::estimator
