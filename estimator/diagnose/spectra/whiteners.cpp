// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/whiteners.h"

#include <algorithm>
#include <complex>
#include <cstddef>
#include <utility>

#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXcd;
using kernels::kBins;

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

/// Complex matrices of kBins frequencies side by side, in the layout of the kernels.
class SideBySide {
 public:
  SideBySide(Index rows, Index columns)
      : rows_(rows),
        columns_(columns),
        numbers_(static_cast<std::size_t>(rows * columns * kNumber)) {}

  Index rows() const { return rows_; }
  Index columns() const { return columns_; }
  double* data() { return numbers_.data(); }
  bool is_zero(Index row, Index column) {
    const double* of_bins = at(row, column, 0);
    return std::all_of(of_bins, of_bins + kNumber, [](double x) { return x == 0; });
  }
  double& real(Index row, Index column, Index k) { return *at(row, column, k); }

  /// Stores the columns of a matrix in this order.
  void put(const MatrixXcd& from, const std::vector<Index>& order, Index k) {
    for (Index j = 0; j < columns_; ++j)
      for (Index i = 0; i < rows_; ++i) {
        const std::complex<double> x = from(i, order[static_cast<std::size_t>(j)]);
        at(i, j, k)[0] = x.real();
        at(i, j, k)[kBins] = x.imag();
      }
  }

  MatrixXcd lower_triangle(Index k) {
    MatrixXcd out = MatrixXcd::Zero(rows_, columns_);
    for (Index i = 0; i < rows_; ++i)
      for (Index j = 0; j <= i; ++j) out(i, j) = {at(i, j, k)[0], at(i, j, k)[kBins]};
    return out;
  }

 private:
  static constexpr Index kNumber = 2 * kBins;

  double* at(Index row, Index column, Index k) {
    return numbers_.data() + (row * columns_ + column) * kNumber + k;
  }

  Index rows_, columns_;
  std::vector<double> numbers_;
};

void add_pushed(const MatrixXd& pushed, Index k, SideBySide& covariance) {
  const Index n = pushed.rows();
  double mean = 0;
  for (Index i = 0; i < n; ++i) mean += covariance.real(i, i, k) / static_cast<double>(n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j <= i; ++j) covariance.real(i, j, k) += mean * pushed(i, j);
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

namespace {

/// Returns the axes sorted by the first equation that contains them. The axes of an equation then
/// lie together, and the kernels skip the others.
std::vector<Index> by_first_equation(const MatrixXcd& operation) {
  const auto first = [&](Index axis) {
    Index i = 0;
    while (i < operation.rows() && operation(i, axis) == std::complex<double>()) ++i;
    return i;
  };
  std::vector<Index> out;
  for (Index a = 0; a < operation.cols(); ++a) out.push_back(a);
  std::stable_sort(out.begin(), out.end(), [&](Index a, Index b) { return first(a) < first(b); });
  return out;
}

/// For every row, the columns that are not zero in all bins lie in [first, end).
struct Extent {
  std::vector<int> first, end;

  explicit Extent(SideBySide& matrix) {
    for (Index i = 0; i < matrix.rows(); ++i) {
      Index from = 0, to = matrix.columns();
      while (from < to && matrix.is_zero(i, from)) ++from;
      while (to > from && matrix.is_zero(i, to - 1)) --to;
      first.push_back(static_cast<int>(from));
      end.push_back(static_cast<int>(to));
    }
  }
};

/// Returns, for every row of the covariance's lower triangle, its first column that is not zero.
/// axes: extent of the rows' axes.
std::vector<int> first_of_covariance(const Extent& axes, const MatrixXd& pushed) {
  std::vector<int> out;
  for (std::size_t i = 0; i < axes.first.size(); ++i) {
    std::size_t j = 0;
    const auto apart = [&] {
      const bool by_axes = axes.end[j] <= axes.first[i] || axes.end[i] <= axes.first[j];
      const auto row = static_cast<Index>(i), column = static_cast<Index>(j);
      return by_axes && (pushed.size() == 0 || pushed(row, column) == 0);
    };
    while (j < i && apart()) ++j;
    out.push_back(static_cast<int>(j));
  }
  return out;
}

}  // namespace

std::vector<Whitener> whiteners(const std::function<MatrixXcd(Index)>& operation,
                                const MatrixXd& noise, const MatrixXd& pushed) {
  const MatrixXcd first_of_all = operation(0);
  const Index n = first_of_all.rows(), axes = first_of_all.cols(), bins = noise.cols();
  std::vector<Whitener> out;
  SideBySide d(n, axes), matrix(n, n);
  Eigen::Matrix<double, kBins, Eigen::Dynamic> variance(kBins, axes);
  const std::vector<Index> order = by_first_equation(first_of_all);
  for (Index first = 0; first < bins; first += kBins) {
    const Index here = std::min<Index>(kBins, bins - first);
    for (Index k = 0; k < kBins; ++k) {  // the last bin fills up the block
      const Index b = first + std::min(k, here - 1);
      d.put(operation(b), order, k);
      variance.row(k) = noise.col(b)(order).transpose();
    }
    const Extent extent(d);
    const std::vector<int> before = first_of_covariance(extent, pushed);
    kernels::in_use->noise_covariance(d.data(), variance.data(), extent.first.data(),
                                      extent.end.data(), static_cast<int>(n),
                                      static_cast<int>(axes), matrix.data());
    for (Index k = 0; k < kBins && pushed.size() > 0; ++k) add_pushed(pushed, k, matrix);
    kernels::in_use->inverse_cholesky(matrix.data(), before.data(), static_cast<int>(n));
    for (Index k = 0; k < here; ++k) {
      out.emplace_back(matrix.lower_triangle(k));
      if (!out.back().is_finite()) return {};
    }
  }
  return out;
}

std::vector<Whitener> whiteners(const std::function<MatrixXcd(Index)>& operation,
                                const MatrixXd& noise, const MatrixXd& pushed,
                                const ReadMotions& motions) {
  const Index n = motions.unread.rows(), axes = noise.rows(), hidden = motions.unread.cols();
  std::vector<Whitener> out;
  for (Index b = 0; b < noise.cols(); ++b) {
    const MatrixXcd d = operation(b), of_hidden = d.rightCols(hidden);
    const MatrixXcd into = motions.read.transpose().cast<Complex>() * of_hidden;
    const ComplexLu own(MatrixXcd(of_hidden.transpose() * motions.unread.cast<Complex>()));
    const MatrixXcd left = motions.read.transpose().cast<Complex>() -
                           own.solve(MatrixXcd(into.transpose())).transpose() *
                               motions.unread.transpose().cast<Complex>();
    const MatrixXcd kept = left * d.leftCols(axes);
    MatrixXcd covariance = kept * noise.col(b).asDiagonal() * kept.adjoint();
    if (pushed.size() > 0) {
      const double mean = covariance.diagonal().real().mean();
      covariance += mean * left * pushed.cast<Complex>() * left.adjoint();
    }
    const ComplexCholesky factor(covariance);
    if (!factor.good()) return {};
    MatrixXcd whole = MatrixXcd::Zero(n, n);
    whole.topRows(n - hidden) = factor.whitened(left);
    out.emplace_back(std::move(whole));
    if (!out.back().is_finite()) return {};
  }
  return out;
}

}  // namespace framewatch::estimator
