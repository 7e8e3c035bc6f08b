// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <Eigen/Core>

namespace framewatch::estimator {

/// A matrix stored row after row.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Eigen's decompositions behind plain functions. Their templates are compiled here only, because
// each costs seconds in every source that names it.

/// The factorization L D L' of a symmetric matrix with pivoting (Eigen::LDLT).
class Ldlt {
 public:
  Ldlt();
  explicit Ldlt(const Eigen::MatrixXd& symmetric);
  Ldlt(const Ldlt& other);
  Ldlt(Ldlt&& other) noexcept;
  Ldlt& operator=(const Ldlt& other);
  Ldlt& operator=(Ldlt&& other) noexcept;
  ~Ldlt();

  /// Returns false if the matrix has a value that is not finite.
  bool good() const;
  bool positive() const;
  /// Returns the diagonal of D.
  Eigen::VectorXd pivots() const;
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  /// Solves for the transpose of `rows`. The result is stored row by row, as `rows` is.
  RowMatrix solve_transposed(const Eigen::MatrixXd& rows) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// The factorization L L' of a symmetric positive definite matrix (Eigen::LLT).
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& symmetric);
  ~Cholesky();

  /// Returns false if the matrix is not positive definite.
  bool good() const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// Returns symmetric^-1 right for a matrix that is positive definite up to rounding. Uses L L' from
/// 200 unknowns on, where it is several times as fast as Ldlt; uses Ldlt below or if a pivot is not
/// positive.
Eigen::VectorXd solve_positive(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& right);

/// The factorization L L^H of a Hermitian positive definite matrix (Eigen::LLT).
class ComplexCholesky {
 public:
  explicit ComplexCholesky(const Eigen::MatrixXcd& hermitian);
  ~ComplexCholesky();

  bool good() const;
  Eigen::MatrixXcd solve(const Eigen::MatrixXcd& right) const;
  /// Returns L^-1 right.
  Eigen::MatrixXcd whitened(const Eigen::MatrixXcd& right) const;
  Eigen::VectorXcd whitened(const Eigen::VectorXcd& right) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// The factorization P L U of a square matrix with partial pivoting (Eigen::PartialPivLU).
class ComplexLu {
 public:
  explicit ComplexLu(const Eigen::MatrixXcd& square);
  ~ComplexLu();

  Eigen::VectorXcd solve(const Eigen::VectorXcd& right) const;
  Eigen::MatrixXcd solve(const Eigen::MatrixXcd& right) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// Returns square^-1 right by P L U with partial pivoting.
Eigen::MatrixXd solve_lu(const Eigen::MatrixXd& square, const Eigen::MatrixXd& right);
Eigen::VectorXd solve_lu(const Eigen::MatrixXd& square, const Eigen::VectorXd& right);
/// Returns hermitian^-1 right by L D L^H.
Eigen::VectorXcd solve_ldlt(const Eigen::MatrixXcd& hermitian, const Eigen::VectorXcd& right);
Eigen::MatrixXd inverse(const Eigen::MatrixXd& square);

/// Least squares: solve() returns the x that minimizes |tall x - right|, by Householder QR with
/// column pivoting.
class LeastSquares {
 public:
  explicit LeastSquares(const Eigen::MatrixXd& tall);
  ~LeastSquares();

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// Returns the orthogonal matrix Q of tall = Q R, rows x rows, by Householder reflections.
Eigen::MatrixXd orthogonal_basis(const Eigen::MatrixXd& tall);

}  // namespace framewatch::estimator
