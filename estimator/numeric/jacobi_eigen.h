#pragma once

#include <vector>

namespace framewatch::estimator {

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
