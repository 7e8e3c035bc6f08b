#include "estimator/diagnose/spectra/whitener.h"

#include <algorithm>
#include <complex>
#include <utility>

#include "estimator/diagnose/spectra/row_gram.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXcd;

namespace {

constexpr Index kSmall =
    24;  ///< equations below which neither triangles nor the kernels are faster
constexpr Index kRowsTogether = 8;

bool is_lower_triangular(const MatrixXcd& matrix) {
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Index i = 0; i < j; ++i)
      if (matrix(i, j) != std::complex<double>()) return false;
  return true;
}

/// to += factor * from. Eigen's own loop reloads the factor in every iteration.
void add_times(std::complex<double> factor, const std::complex<double>* from, Index count,
               std::complex<double>* to) {
  const double re = factor.real(), im = factor.imag();
  for (Index i = 0; i < count; ++i)
    to[i] += std::complex<double>(re * from[i].real() - im * from[i].imag(),
                                  re * from[i].imag() + im * from[i].real());
}

}  // namespace

Whitener::Whitener(MatrixXcd whole) : equations_(whole.rows()) {
  const Index n = equations_;
  if (n < kSmall || !is_lower_triangular(whole)) {
    whole_ = std::move(whole);
    return;
  }
  triangle_.resize(n * (n + 1) / 2);
  Index next = 0;
  for (Index j = 0; j < n; next += n - j, ++j)
    triangle_.segment(next, n - j) = whole.col(j).tail(n - j);
}

Eigen::Map<const VectorXcd> Whitener::column(Index j) const {
  const Index before = j * equations_ - j * (j - 1) / 2;
  return {triangle_.data() + before, equations_ - j};
}

VectorXcd Whitener::times(const Ref<const VectorXcd>& forces) const {
  if (triangle_.size() == 0) return whole_ * forces;
  VectorXcd out = VectorXcd::Zero(equations_);
  for (Index j = 0; j < equations_; ++j)
    if (forces[j] != std::complex<double>())  // forces of elements act on few equations
      add_times(forces[j], column(j).data(), equations_ - j, out.data() + j);
  return out;
}

VectorXcd Whitener::adjoint_times(const Ref<const VectorXcd>& rows) const {
  if (triangle_.size() == 0) return whole_.adjoint() * rows;
  VectorXcd out(equations_);
  for (Index j = 0; j < equations_; ++j) out[j] = column(j).dot(rows.tail(equations_ - j));
  return out;
}

/// Starts with the last columns: then the rows of a triangle end alike, and longer rows need none
/// of the columns before. Stores a column's real part, then its imaginary part.
MatrixXcd Whitener::metric() const {
  const Index n = equations_;
  if (n < kSmall) return whole_.adjoint().lazyProduct(whole_);
  RowGram gram(2 * n);
  const bool triangular = triangle_.size() > 0;
  const MatrixXcd w = whole();
  for (Index end = n, count = 0; end > 0; end -= count) {
    count = triangular ? std::min(end, kRowsTogether) : n;
    auto rows = gram.rows(count, 2 * (n - end));
    rows.setZero();
    for (Index r = 0; r < count; ++r) {
      const Index k = end - count + r, columns = triangular ? k + 1 : n;
      for (Index j = 0; j < columns; ++j) {
        const Index at = 2 * (end - 1 - j);
        rows(r, at) = w(k, j).real();
        rows(r, at + 1) = w(k, j).imag();
      }
    }
    gram.add();
  }
  const MatrixXd sum = gram.sum();
  MatrixXcd out(n, n);
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index a = 2 * (n - 1 - i), b = 2 * (n - 1 - j);
      out(i, j) = {sum(a, b) + sum(a + 1, b + 1), sum(a, b + 1) - sum(a + 1, b)};
    }
  return out;
}

MatrixXcd Whitener::whole() const {
  if (triangle_.size() == 0) return whole_;
  MatrixXcd out = MatrixXcd::Zero(equations_, equations_);
  for (Index j = 0; j < equations_; ++j) out.col(j).tail(equations_ - j) = column(j);
  return out;
}

double Whitener::squared_norm() const {
  return triangle_.size() == 0 ? whole_.squaredNorm() : triangle_.squaredNorm();
}

bool Whitener::is_finite() const {
  return triangle_.size() == 0 ? whole_.allFinite() : triangle_.allFinite();
}

}  // namespace framewatch::estimator
