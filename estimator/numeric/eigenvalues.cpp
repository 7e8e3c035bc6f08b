// SPDX-License-Identifier: MIT
#include "estimator/numeric/eigenvalues.h"

#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace framewatch::estimator {

using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

RealEigen symmetric_eigen(const MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(a);
  return {solver.info() == Eigen::Success, solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd symmetric_eigenvalues(const MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

RealEigen generalized_eigen(const MatrixXd& a, const MatrixXd& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(a, b);
  return {solver.info() == Eigen::Success, solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd generalized_eigenvalues(const MatrixXd& a, const MatrixXd& b) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(a, b, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

ComplexEigen general_eigen(const MatrixXd& a) {
  const Eigen::EigenSolver<MatrixXd> solver(a);
  if (solver.info() != Eigen::Success) return {};
  return {true, solver.eigenvalues(), solver.eigenvectors()};
}

VectorXcd general_eigenvalues(const MatrixXd& a) {
  return Eigen::EigenSolver<MatrixXd>(a, false).eigenvalues();
}

SingularValues singular_values(const MatrixXd& matrix) {
  const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& square) {
  return square.exp();
}

namespace {

constexpr int kMaxSweeps = 30;  // a dozen rows need six sweeps
constexpr double kNegligible = 1e-17;

}  // namespace

void JacobiEigen::rotate(int p, int q, int size) {
  const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
  const double t = std::copysign(1 / (std::abs(theta) + std::sqrt(theta * theta + 1)), theta);
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (int i = 0; i < size; ++i) {
    const double ip = a(i, p), iq = a(i, q);
    a(i, p) = c * ip - s * iq;
    a(i, q) = s * ip + c * iq;
  }
  for (int i = 0; i < size; ++i) {
    const double pi = a(p, i), qi = a(q, i);
    a(p, i) = c * pi - s * qi;
    a(q, i) = s * pi + c * qi;
    const double vp = v(i, p), vq = v(i, q);
    v(i, p) = c * vp - s * vq;
    v(i, q) = s * vp + c * vq;
  }
  a(p, q) = a(q, p) = 0;
}

void JacobiEigen::compute(const double* matrix, int size) {
  double scale = 0;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      a(i, j) = matrix[i * size + j];
      v(i, j) = i == j ? 1 : 0;
      scale += a(i, j) * a(i, j);
    }
  }
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double off = 0;
    for (int p = 0; p < size; ++p)
      for (int q = p + 1; q < size; ++q) off += a(p, q) * a(p, q);
    if (!(off > kNegligible * kNegligible * scale)) break;
    for (int p = 0; p < size; ++p)
      for (int q = p + 1; q < size; ++q)
        if (a(p, q) != 0) rotate(p, q, size);
  }
  for (int k = 0; k < size; ++k) {
    int least = k;
    for (int j = k + 1; j < size; ++j)
      if (a(j, j) < a(least, least)) least = j;
    std::swap(a(k, k), a(least, least));
    for (int i = 0; i < size && least != k; ++i) std::swap(v(i, k), v(i, least));
    values_[static_cast<std::size_t>(k)] = a(k, k);
  }
}

}  // namespace framewatch::estimator
