#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

// Eigen's eigenvalue problems and matrix functions behind plain functions (see solve.h).

/// values: ascending; vectors: in columns, empty where only values were asked for.
struct RealEigen {
  bool good = false;
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// a x = lambda x of a symmetric a.
RealEigen symmetric_eigen(const Eigen::MatrixXd& a);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);
/// a x = lambda b x, a symmetric, b symmetric and positive; vectors of x' b x = 1.
RealEigen generalized_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

struct ComplexEigen {
  bool good = false;
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// a x = lambda x of any real square a.
ComplexEigen general_eigen(const Eigen::MatrixXd& a);
Eigen::VectorXcd general_eigenvalues(const Eigen::MatrixXd& a);

/// matrix = left diag(values) right', values descending, thin.
struct SingularValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd left, right;
};
SingularValues singular_values(const Eigen::MatrixXd& matrix);

/// e^square, by scaling and squaring.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& square);

/// Eigenvalues, ascending, and orthonormal eigenvectors of a small symmetric matrix, by cyclic
/// Jacobi rotations. Allocates when constructed, never after.
class JacobiEigen {
 public:
  explicit JacobiEigen(int most) : most_(most) {
    for (std::vector<double>* work : {&matrix_, &vectors_})
      work->resize(static_cast<std::size_t>(most * most));
    values_.resize(static_cast<std::size_t>(most));
  }

  /// size <= most. matrix: size x size, row-major.
  void compute(const double* matrix, int size);
  double value(int k) const { return values_[static_cast<std::size_t>(k)]; }
  /// Entry i of eigenvector k.
  double vector(int i, int k) const { return vectors_[static_cast<std::size_t>(i * most_ + k)]; }

 private:
  double& a(int i, int j) { return matrix_[static_cast<std::size_t>(i * most_ + j)]; }
  double& v(int i, int k) { return vectors_[static_cast<std::size_t>(i * most_ + k)]; }
  void rotate(int p, int q, int size);

  int most_;
  std::vector<double> matrix_, vectors_, values_;
};

}  // namespace framewatch::estimator
