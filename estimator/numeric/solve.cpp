// SPDX-License-Identifier: MIT
#include "estimator/numeric/solve.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

namespace framewatch::estimator {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

struct Ldlt::Factor {
  Eigen::LDLT<MatrixXd> ldlt;
};

Ldlt::Ldlt() : factor_(std::make_unique<Factor>()) {}
Ldlt::Ldlt(const MatrixXd& symmetric) : Ldlt() {
  factor_->ldlt.compute(symmetric);
}
Ldlt::Ldlt(const Ldlt& other) : factor_(std::make_unique<Factor>(*other.factor_)) {}
Ldlt::Ldlt(Ldlt&& other) noexcept = default;
Ldlt& Ldlt::operator=(const Ldlt& other) {
  factor_ = std::make_unique<Factor>(*other.factor_);
  return *this;
}
Ldlt& Ldlt::operator=(Ldlt&& other) noexcept = default;
Ldlt::~Ldlt() = default;

bool Ldlt::good() const {
  return factor_->ldlt.info() == Eigen::Success;
}
bool Ldlt::positive() const {
  return factor_->ldlt.isPositive();
}
VectorXd Ldlt::pivots() const {
  return factor_->ldlt.vectorD();
}
VectorXd Ldlt::solve(const VectorXd& right) const {
  return factor_->ldlt.solve(right);
}
MatrixXd Ldlt::solve(const MatrixXd& right) const {
  return factor_->ldlt.solve(right);
}

RowMatrix Ldlt::solve_transposed(const MatrixXd& rows) const {
  return factor_->ldlt.solve(rows.transpose());
}

struct Cholesky::Factor {
  Eigen::LLT<MatrixXd> llt;
};

Cholesky::Cholesky(const MatrixXd& symmetric)
    : factor_(std::make_unique<Factor>(Factor{Eigen::LLT<MatrixXd>(symmetric)})) {}
Cholesky::~Cholesky() = default;

bool Cholesky::good() const {
  return factor_->llt.info() == Eigen::Success;
}
MatrixXd Cholesky::solve(const MatrixXd& right) const {
  return factor_->llt.solve(right);
}

struct ComplexCholesky::Factor {
  Eigen::LLT<MatrixXcd> llt;
};

ComplexCholesky::ComplexCholesky(const MatrixXcd& hermitian)
    : factor_(std::make_unique<Factor>(Factor{Eigen::LLT<MatrixXcd>(hermitian)})) {}
ComplexCholesky::~ComplexCholesky() = default;

bool ComplexCholesky::good() const {
  return factor_->llt.info() == Eigen::Success;
}
MatrixXcd ComplexCholesky::solve(const MatrixXcd& right) const {
  return factor_->llt.solve(right);
}
MatrixXcd ComplexCholesky::whitened(const MatrixXcd& right) const {
  MatrixXcd out = right;
  factor_->llt.matrixL().solveInPlace(out);
  return out;
}
VectorXcd ComplexCholesky::whitened(const VectorXcd& right) const {
  VectorXcd out = right;
  factor_->llt.matrixL().solveInPlace(out);
  return out;
}

struct ComplexLu::Factor {
  Eigen::PartialPivLU<MatrixXcd> lu;
};

ComplexLu::ComplexLu(const MatrixXcd& square)
    : factor_(std::make_unique<Factor>(Factor{Eigen::PartialPivLU<MatrixXcd>(square)})) {}
ComplexLu::~ComplexLu() = default;

VectorXcd ComplexLu::solve(const VectorXcd& right) const {
  return factor_->lu.solve(right);
}
MatrixXcd ComplexLu::solve(const MatrixXcd& right) const {
  return factor_->lu.solve(right);
}

MatrixXd solve_lu(const MatrixXd& square, const MatrixXd& right) {
  return square.partialPivLu().solve(right);
}
VectorXd solve_lu(const MatrixXd& square, const VectorXd& right) {
  return square.partialPivLu().solve(right);
}
VectorXcd solve_ldlt(const MatrixXcd& hermitian, const VectorXcd& right) {
  return hermitian.ldlt().solve(right);
}
MatrixXd inverse(const MatrixXd& square) {
  return square.inverse();
}

struct LeastSquares::Factor {
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
};

LeastSquares::LeastSquares(const MatrixXd& tall)
    : factor_(std::make_unique<Factor>(Factor{Eigen::ColPivHouseholderQR<MatrixXd>(tall)})) {}
LeastSquares::~LeastSquares() = default;

VectorXd LeastSquares::solve(const VectorXd& right) const {
  return factor_->qr.solve(right);
}

VectorXd solve_positive(const MatrixXd& symmetric, const VectorXd& right) {
  constexpr Eigen::Index kPays = 200;  // number of unknowns from which Cholesky is faster
  if (symmetric.cols() >= kPays)
    if (const Cholesky quick(symmetric); quick.good()) return quick.solve(MatrixXd(right));
  return Ldlt(symmetric).solve(right);
}

MatrixXd orthogonal_basis(const MatrixXd& tall) {
  return Eigen::HouseholderQR<MatrixXd>(tall).householderQ();
}

}  // namespace framewatch::estimator
