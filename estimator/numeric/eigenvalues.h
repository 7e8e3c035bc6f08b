// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

// Eigen's eigenvalue problems and matrix functions behind plain functions. solve.h says why. A
// result with `good` false means that the iteration did not converge.

/// Eigenvalues in ascending order, and eigenvectors as columns. `vectors` is empty if only values
/// were requested.
struct RealEigen {
  bool good = false;
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Solves a x = lambda x for a symmetric matrix a.
RealEigen symmetric_eigen(const Eigen::MatrixXd& a);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);
/// Solves a x = lambda b x for symmetric a and symmetric positive definite b. Eigenvectors satisfy
/// x' b x = 1.
RealEigen generalized_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

struct ComplexEigen {
  bool good = false;
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// Solves a x = lambda x for any real square matrix a.
ComplexEigen general_eigen(const Eigen::MatrixXd& a);
Eigen::VectorXcd general_eigenvalues(const Eigen::MatrixXd& a);

/// The thin singular value decomposition: matrix = left diag(values) right', values descending.
struct SingularValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd left, right;
};
SingularValues singular_values(const Eigen::MatrixXd& matrix);

/// Returns e^square, computed by scaling and squaring.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& square);

/// Computes the eigenvalues, ascending, and orthonormal eigenvectors of a small symmetric matrix by
/// cyclic Jacobi rotations. Allocates only in the constructor.
class JacobiEigen {
 public:
  explicit JacobiEigen(int most) : most_(most) {
    for (std::vector<double>* work : {&matrix_, &vectors_})
      work->resize(static_cast<std::size_t>(most * most));
    values_.resize(static_cast<std::size_t>(most));
  }

  /// Decomposes `matrix`, size x size, row-major. size must not exceed the constructor's `most`.
  void compute(const double* matrix, int size);
  double value(int k) const { return values_[static_cast<std::size_t>(k)]; }
  /// Returns entry i of eigenvector k.
  double vector(int i, int k) const { return vectors_[static_cast<std::size_t>(i * most_ + k)]; }

 private:
  double& a(int i, int j) { return matrix_[static_cast<std::size_t>(i * most_ + j)]; }
  double& v(int i, int k) { return vectors_[static_cast<std::size_t>(i * most_ + k)]; }
  void rotate(int p, int q, int size);

  int most_;
  std::vector<double> matrix_, vectors_, values_;
};

}  // namespace framewatch::estimator
