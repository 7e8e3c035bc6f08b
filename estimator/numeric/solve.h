#pragma once

#include <memory>

#include <Eigen/Core>

namespace framewatch::estimator {

/// Rows of numbers, row after row in memory.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Eigen's decompositions behind plain functions, so that their templates are compiled here and
// nowhere else: each costs seconds of every source that names it.

/// L D L' of a symmetric matrix, with pivoting (Eigen::LDLT).
class Ldlt {
 public:
  Ldlt();
  explicit Ldlt(const Eigen::MatrixXd& symmetric);
  Ldlt(const Ldlt& other);
  Ldlt(Ldlt&& other) noexcept;
  Ldlt& operator=(const Ldlt& other);
  Ldlt& operator=(Ldlt&& other) noexcept;
  ~Ldlt();

  /// False when the matrix is not finite.
  bool good() const;
  bool positive() const;
  /// The diagonal of D.
  Eigen::VectorXd pivots() const;
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  /// Of the transpose of `rows`, along its rows as they lie in memory.
  RowMatrix solve_transposed(const Eigen::MatrixXd& rows) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// L L' of a symmetric positive matrix (Eigen::LLT).
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& symmetric);
  ~Cholesky();

  /// False when the matrix is not positive definite.
  bool good() const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// symmetric^-1 right of a matrix that is positive definite but for rounding: by L L' where there
/// are hundreds of unknowns, then several times as fast as Ldlt; by that one where there are fewer
/// or a pivot is not positive.
Eigen::VectorXd solve_positive(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& right);

/// L L^H of a Hermitian positive matrix (Eigen::LLT).
class ComplexCholesky {
 public:
  explicit ComplexCholesky(const Eigen::MatrixXcd& hermitian);
  ~ComplexCholesky();

  bool good() const;
  Eigen::MatrixXcd solve(const Eigen::MatrixXcd& right) const;
  /// L^-1 right.
  Eigen::MatrixXcd whitened(const Eigen::MatrixXcd& right) const;
  Eigen::VectorXcd whitened(const Eigen::VectorXcd& right) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// P L U of a square matrix with partial pivoting (Eigen::PartialPivLU).
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

/// square^-1 right, by P L U with partial pivoting.
Eigen::MatrixXd solve_lu(const Eigen::MatrixXd& square, const Eigen::MatrixXd& right);
Eigen::VectorXd solve_lu(const Eigen::MatrixXd& square, const Eigen::VectorXd& right);
/// hermitian^-1 right, by L D L^H.
Eigen::VectorXcd solve_ldlt(const Eigen::MatrixXcd& hermitian, const Eigen::VectorXcd& right);
Eigen::MatrixXd inverse(const Eigen::MatrixXd& square);

/// The x with the least |tall x - right|, by Householder QR with column pivoting.
class LeastSquares {
 public:
  explicit LeastSquares(const Eigen::MatrixXd& tall);
  ~LeastSquares();

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// The orthogonal Q of tall = Q R, rows x rows, by Householder reflections.
Eigen::MatrixXd orthogonal_basis(const Eigen::MatrixXd& tall);

}  // namespace framewatch::estimator
