#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// The matrix that whitens the equations of one bin. Of a large lower triangle only the triangle is
/// kept: those of a tall building take most of the memory.
class Whitener {
 public:
  explicit Whitener(Eigen::MatrixXcd whole);

  Eigen::Index equations() const { return equations_; }
  /// Its product with forces on the equations.
  Eigen::VectorXcd times(const Eigen::Ref<const Eigen::VectorXcd>& forces) const;
  /// whitener^H rows.
  Eigen::VectorXcd adjoint_times(const Eigen::Ref<const Eigen::VectorXcd>& rows) const;
  /// whitener^H whitener.
  Eigen::MatrixXcd metric() const;
  Eigen::MatrixXcd whole() const;
  /// Sum of the squares of its numbers.
  double squared_norm() const;
  bool is_finite() const;

 private:
  /// Column j of the triangle, from the diagonal on.
  Eigen::Map<const Eigen::VectorXcd> column(Eigen::Index j) const;

  Eigen::Index equations_;
  Eigen::MatrixXcd whole_;     ///< empty where the triangle is kept
  Eigen::VectorXcd triangle_;  ///< column after column
};

}  // namespace framewatch::estimator
