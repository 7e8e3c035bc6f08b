#include "estimator/diagnose/spectra/weights.h"

#include <cmath>
#include <utility>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kEndTerms = 4;
constexpr Index kSmall = 24;  ///< equations below which the kernels do not pay

Weights::Weights(std::vector<MatrixXcd> whitener, const VectorXd& w,
                 std::vector<HiddenOscillator> hidden, MatrixXd read)
    : whitener_(std::move(whitener)),
      relative_(w / std::sqrt(w[0] * w[w.size() - 1])),
      hidden_(std::move(hidden)),
      read_(std::move(read)) {
  const Index n = equations();
  scale_ = VectorXd::Ones(kEndTerms * n + 2 * static_cast<Index>(hidden_.size()));
  RowMatrix sum = RowMatrix::Zero(ends(), ends());
  RowMatrix square(2 * n, 2 * n), along, turned;
  for (Index b = 0; b < bins(); ++b) {
    const MatrixXcd inner = metric(b);  // of unit forces, real ones and then those of value -j
    square.topLeftCorner(n, n) = square.bottomRightCorner(n, n) = inner.real();
    square.topRightCorner(n, n) = inner.imag();
    square.bottomLeftCorner(n, n) = -inner.imag();
    along.setZero(ends(), 2 * n);
    add_shares(b, square, along);
    turned = along.transpose();
    add_shares(b, turned, sum);
  }
  scale_ = sum.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  square_ = scale_.asDiagonal() * sum * scale_.asDiagonal();
  MatrixXd regular = square_;
  // End terms of motions that no axis reads are nearly alike far from their frequencies.
  regular.diagonal().array() += read_.size() > 0 ? 1e-10 : 1e-12;
  factor_ = Ldlt(regular);
}

VectorXcd Weights::forces_of(Index bin, const VectorXcd& rows) const {
  const MatrixXcd& w = whitener(bin);
  if (read_.size() == 0) return w.triangularView<Eigen::Lower>().solve(rows);
  const Index count = read_.cols();
  const MatrixXcd own = w.topRows(count) * read_.cast<Complex>();
  return read_.cast<Complex>() *
         own.triangularView<Eigen::Lower>().solve(VectorXcd(rows.head(count)));
}

MatrixXcd Weights::metric(Index bin) const {
  const MatrixXcd& w = whitener(bin);
  const Index n = w.rows();
  if (n < kSmall) return w.adjoint().lazyProduct(w);
  RowGram gram(2 * n);
  auto rows = gram.rows(n);
  rows.leftCols(n) = w.real();
  rows.rightCols(n) = w.imag();
  gram.add();
  const MatrixXd sum = gram.sum(), cross = sum.topRightCorner(n, n);
  MatrixXcd out(n, n);
  out.real() = sum.topLeftCorner(n, n) + sum.bottomRightCorner(n, n);
  out.imag() = cross - cross.transpose();
  return out;
}

void Weights::put_unit_forces(Index bin, bool transposed, RowMatrix& out) const {
  const MatrixXcd& w = whitener(bin);
  const Index n = w.rows();
  out.setZero(2 * n, padded(static_cast<int>(2 * n)));
  const bool triangular = read_.size() == 0;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < (triangular ? i + 1 : n); ++j) {
      const Index row = transposed ? j : i, column = transposed ? i : j;
      out(row, column) = w(i, j).real();
      out(n + row, n + column) = -w(i, j).real();
      out(n + row, column) = out(row, n + column) = w(i, j).imag();
    }
}

/// With r the relative frequency the terms are r^-2, -j/r, 1 and j r at every equation.
void Weights::add_shares(Index bin, const RowMatrix& along, RowMatrix& sum) const {
  const Index n = equations();
  const double r = relative_[bin];
  const double share[] = {1 / (r * r), 1 / r, 1, -r};
  for (Index term = 0; term < kEndTerms; ++term)
    for (Index i = 0; i < n; ++i)
      sum.row(term * n + i) += (share[term] * scale_[term * n + i]) * along.row(term % 2 * n + i);
  Index row = kEndTerms * n;
  for (const HiddenOscillator& h : hidden_) {
    const double re = h.transmissibility[bin].real(), im = h.transmissibility[bin].imag();
    const Eigen::RowVectorXd x = h.direction.transpose() * along.topRows(n),
                             y = h.direction.transpose() * along.middleRows(n, n);
    sum.row(row) += scale_[row] * (re * x - im * y);
    sum.row(row + 1) -= scale_[row + 1] * r * (im * x + re * y);
    row += 2;
  }
}

VectorXd Weights::shared(Index bin, const VectorXd& size) const {
  const Index n = equations();
  const double r = relative_[bin];
  const auto of = [&](Index term) { return size.segment(term * n, n); };
  VectorXd out(2 * n);
  out.head(n) = of(0) / (r * r) + of(2);
  out.tail(n) = of(1) / r - r * of(3);
  Index row = kEndTerms * n;
  for (const HiddenOscillator& h : hidden_) {
    const double re = h.transmissibility[bin].real(), im = h.transmissibility[bin].imag();
    out.head(n) += (re * size[row] - r * im * size[row + 1]) * h.direction;
    out.tail(n) -= (im * size[row] + r * re * size[row + 1]) * h.direction;
    row += 2;
  }
  return out;
}

RowMatrix Weights::times_ends(Index bin, const RowMatrix& left) const {
  RowMatrix forces, along, out = RowMatrix::Zero(ends(), left.rows());
  put_unit_forces(bin, false, forces);
  multiply(left, forces, along);
  add_shares(bin, along.transpose(), out);
  return out.transpose();
}

VectorXd Weights::without_ends(const VectorXd& rows) const {
  const Index n = equations();
  RowMatrix forces, sum = RowMatrix::Zero(ends(), 1);
  for (Index b = 0; b < bins(); ++b) {
    put_unit_forces(b, true, forces);
    add_shares(b, forces.leftCols(2 * n) * rows.segment(2 * n * b, 2 * n), sum);
  }
  const VectorXd size = scale_.cwiseProduct(factor_.solve(VectorXd(sum)));
  VectorXd out = rows;
  for (Index b = 0; b < bins(); ++b) {
    put_unit_forces(b, false, forces);
    out.segment(2 * n * b, 2 * n).noalias() -= forces.leftCols(2 * n) * shared(b, size);
  }
  return out;
}

}  // namespace framewatch::estimator
