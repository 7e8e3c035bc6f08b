// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/weights.h"

#include <cmath>
#include <complex>
#include <utility>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kEndTerms = 4;

namespace {

/// Every end term is a power of the relative frequency, with this sign. It multiplies a real force
/// (even) or a force of value -j (odd) on each equation.
constexpr int kPower[kEndTerms] = {-2, -1, 0, 1};
constexpr double kSign[kEndTerms] = {1, 1, 1, -1};
constexpr int kMinPower = 2 * kPower[0], kPowers = 2 * kPower[kEndTerms - 1] - kMinPower + 1;

/// Sums over the bins of the metric's real part (even powers) or imaginary part (odd powers), times
/// that power of the relative frequency.
class MetricMoments {
 public:
  explicit MetricMoments(Index n)
      : n_(n),
        even_(RowMatrix::Zero((kPowers + 1) / 2, padded(static_cast<int>(n * n)))),
        odd_(RowMatrix::Zero(kPowers / 2, even_.cols())),
        real_(RowMatrix::Zero(kTogether, even_.cols())),
        imaginary_(real_),
        even_factor_(even_.rows(), kTogether),
        odd_factor_(odd_.rows(), kTogether) {}

  void add(const MatrixXcd& metric, double relative) {
    const Eigen::Map<const Eigen::RowVectorXcd> row(metric.data(), n_ * n_);
    real_.row(waiting_).head(n_ * n_) = row.real();
    imaginary_.row(waiting_).head(n_ * n_) = row.imag();
    double factor = std::pow(relative, kMinPower);
    for (Index p = 0; p < kPowers; ++p, factor *= relative)
      (p % 2 == 0 ? even_factor_ : odd_factor_)(p / 2, waiting_) = factor;
    if (++waiting_ == kTogether) add_waiting();
  }

  /// Adds the remaining bins. Call it before between().
  void add_waiting() {
    const auto add = [&](const RowMatrix& factors, const RowMatrix& values, RowMatrix& sum) {
      kernels::in_use->multiply_add(factors.data(), kTogether, static_cast<int>(factors.rows()),
                                    static_cast<int>(waiting_), values.data(), sum.data(),
                                    static_cast<int>(sum.cols()));
    };
    add(even_factor_, real_, even_);
    add(odd_factor_, imaginary_, odd_);
    waiting_ = 0;
  }

  /// Returns the products of the columns of two end terms.
  MatrixXd between(Index a, Index b) const {
    const Index power = kPower[a] + kPower[b] - kMinPower;
    const double* of_power = (power % 2 == 0 ? even_ : odd_).row(power / 2).data();
    const Eigen::Map<const MatrixXd> sum(of_power, n_, n_);
    const bool turned = a % 2 != 0 && b % 2 == 0;
    return (turned ? -kSign[a] : kSign[a]) * kSign[b] * sum;
  }

 private:
  static constexpr int kTogether = 8;  ///< bins

  Index n_, waiting_ = 0;
  RowMatrix even_, odd_;  ///< powers x numbers of the metric
  RowMatrix real_, imaginary_;
  RowMatrix even_factor_, odd_factor_;
};

}  // namespace

VectorXcd rows_of_bin(const Eigen::Ref<const VectorXd>& rows, Index bin, Index equations) {
  VectorXcd out(equations);
  out.real() = rows.segment(2 * equations * bin, equations);
  out.imag() = rows.segment(2 * equations * bin + equations, equations);
  return out;
}

Weights::Weights(std::vector<Whitener> whitener, const VectorXd& w,
                 std::vector<HiddenOscillator> hidden, MatrixXd read)
    : whitener_(std::move(whitener)),
      relative_(w / std::sqrt(w[0] * w[w.size() - 1])),
      hidden_(std::move(hidden)),
      read_(std::move(read)) {
  const Index n = equations(), columns = 2 * static_cast<Index>(hidden_.size());
  scale_ = VectorXd::Ones(kEndTerms * n + columns);
  MatrixXd sum = MatrixXd::Zero(ends(), ends());
  MetricMoments moments(n);
  MatrixXcd forces(n, columns);
  RowMatrix along(2 * n, columns), shares = RowMatrix::Zero(ends(), columns);
  for (Index b = 0; b < bins(); ++b) {
    const MatrixXcd inner = metric(b);
    moments.add(inner, relative_[b]);
    if (columns == 0) continue;
    for (std::size_t h = 0; h < hidden_.size(); ++h) {
      const auto c = 2 * static_cast<Index>(h);
      forces.col(c) = hidden_[h].direction * hidden_[h].transmissibility[b];
      forces.col(c + 1) = Complex(0, relative_[b]) * forces.col(c);
    }
    const MatrixXcd under = inner * forces;
    along.topRows(n) = under.real();
    along.bottomRows(n) = -under.imag();
    add_shares(b, along, shares);
  }
  moments.add_waiting();
  for (Index i = 0; i < kEndTerms; ++i)
    for (Index j = 0; j < kEndTerms; ++j) sum.block(i * n, j * n, n, n) = moments.between(i, j);
  sum.rightCols(columns) = shares;
  sum.bottomRows(columns) = shares.transpose();
  scale_ = sum.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  square_ = scale_.asDiagonal() * sum * scale_.asDiagonal();
  MatrixXd regular = square_;
  // End terms of motions that no axis reads are nearly alike far from their frequencies.
  regular.diagonal().array() += is_triangular() ? 1e-12 : 1e-10;
  factor_ = Ldlt(regular);
}

VectorXcd Weights::forces_of(Index bin, const VectorXcd& rows) const {
  const MatrixXcd w = whitener(bin).whole();
  if (is_triangular()) return w.triangularView<Eigen::Lower>().solve(rows);
  const Index count = read_.cols();
  const MatrixXcd own = w.topRows(count) * read_.cast<Complex>();
  return read_.cast<Complex>() *
         own.triangularView<Eigen::Lower>().solve(VectorXcd(rows.head(count)));
}

void Weights::put_unit_forces(Index bin, bool transposed, RowMatrix& out) const {
  const MatrixXcd w = whitener(bin).whole();
  const Index n = w.rows();
  out.setZero(2 * n, padded(static_cast<int>(2 * n)));
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < (is_triangular() ? i + 1 : n); ++j) {
      const Index row = transposed ? j : i, column = transposed ? i : j;
      out(row, column) = w(i, j).real();
      out(n + row, n + column) = -w(i, j).real();
      out(n + row, column) = out(row, n + column) = w(i, j).imag();
    }
}

/// With r the relative frequency, the terms are r^-2, -j/r, 1 and j r at every equation.
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

VectorXd Weights::whitened(const MatrixXcd& forces) const {
  const Index n = equations();
  VectorXd out(2 * forces.size());
  for (Index b = 0; b < forces.cols(); ++b) {
    const VectorXcd row = whitener(b).times(forces.col(b));
    out.segment(2 * n * b, n) = row.real();
    out.segment(2 * n * b + n, n) = row.imag();
  }
  return out;
}

MatrixXcd Weights::turned_back(const VectorXd& rows) const {
  const Index n = equations();
  MatrixXcd out(n, bins());
  VectorXcd row(n);
  for (Index b = 0; b < bins(); ++b) {
    row.real() = rows.segment(2 * n * b, n);
    row.imag() = rows.segment(2 * n * b + n, n);
    out.col(b) = whitener(b).adjoint_times(row);
  }
  return out;
}

VectorXd Weights::without_ends(const VectorXd& rows) const {
  const Index n = equations();
  const MatrixXcd turned = turned_back(rows);
  RowMatrix along(2 * n, 1), sum = RowMatrix::Zero(ends(), 1);
  for (Index b = 0; b < bins(); ++b) {
    along.col(0).head(n) = turned.col(b).real();
    along.col(0).tail(n) = -turned.col(b).imag();
    add_shares(b, along, sum);
  }
  const VectorXd size = scale_.cwiseProduct(factor_.solve(VectorXd(sum)));
  MatrixXcd forces(n, bins());
  for (Index b = 0; b < bins(); ++b) {
    const VectorXd of_bin = shared(b, size);
    forces.col(b).real() = of_bin.head(n);
    forces.col(b).imag() = -of_bin.tail(n);
  }
  return rows - whitened(forces);
}

}  // namespace framewatch::estimator
