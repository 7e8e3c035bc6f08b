// SPDX-License-Identifier: MIT
#include "estimator/refine/segment_likelihood.h"

#include <cmath>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kRidge = 1e-9;

/// Solves A z = b by a Cholesky factorization of A scaled to a unit diagonal.
class ScaledCholesky {
 public:
  explicit ScaledCholesky(const MatrixXd& matrix)
      : scale_(matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()),
        factor_(scale_.asDiagonal() * matrix * scale_.asDiagonal()) {}
  bool good() const { return factor_.good() && scale_.allFinite(); }
  MatrixXd solve(const MatrixXd& right) const {
    return scale_.asDiagonal() * factor_.solve(scale_.asDiagonal() * right);
  }

 private:
  VectorXd scale_;
  Cholesky factor_;
};

}  // namespace

SegmentLikelihood::SegmentLikelihood(Index equations, Index parameters, const VectorXd& variance,
                                     const Spectrum& spectrum, EndTerms terms, Index inner_ends)
    : equations_(equations),
      parameters_(parameters),
      spectrum_(spectrum),
      terms_(static_cast<Index>(terms)),
      inner_ends_(inner_ends),
      variance_(variance),
      noise_(spectrum.intervals * variance),
      bins_(static_cast<std::size_t>(spectrum.bins())) {
  if (bins_.empty()) return;
  const double middle = std::sqrt(spectrum.w[0] * spectrum.w[spectrum.bins() - 1]);
  for (Index b = 0; b < spectrum.bins(); ++b) {
    const double ratio = spectrum.w[b] / middle;
    auto& end = bins_[static_cast<std::size_t>(b)].end;
    end = {1 / (ratio * ratio), 1.0 / (kJ * ratio), 1, kJ * ratio};
    end.resize(static_cast<std::size_t>(terms_));
  }
}

double SegmentLikelihood::observations() const {
  return static_cast<double>(spectrum_.bins() * equations_);
}

bool SegmentLikelihood::prepare(const VectorXd& theta) {
  if (bins_.empty() || theta.size() != parameters_ || !theta.allFinite()) return false;
  if (!operate(theta)) return false;
  const MatrixXcd identity = MatrixXcd::Identity(equations_, equations_);
  for (Index b = 0; b < spectrum_.bins(); ++b) {
    Bin& bin = bins_[static_cast<std::size_t>(b)];
    const MatrixXcd omega = bin.operation * noise_.asDiagonal() * bin.operation.adjoint();
    const ComplexCholesky factor(omega);
    if (!factor.good()) return false;
    bin.weight = factor.solve(identity);
    bin.residual = bin.operation * spectrum_.accel.col(b);
  }
  return fit_ends();
}

bool SegmentLikelihood::fit_ends() {
  const Index n = equations_, all = end_unknowns();
  ends_ = MatrixXd::Zero(all, all);
  VectorXd right = VectorXd::Zero(all);
  for (const Bin& bin : bins_) {
    const VectorXcd weighted = bin.weight * bin.residual;
    for (Index r = 0; r < terms_; ++r) {
      const Complex row = std::conj(bin.end[static_cast<std::size_t>(r)]);
      right.segment(r * n, n) += 2 * (row * weighted).real();
      for (Index c = 0; c < terms_; ++c)
        ends_.block(r * n, c * n, n, n) +=
            2 * (row * bin.end[static_cast<std::size_t>(c)] * bin.weight).real();
    }
    if (inner_ends_ == 0) continue;
    const MatrixXcd seen = bin.weight * bin.inner_end;
    right.tail(inner_ends_) += 2 * (bin.inner_end.adjoint() * weighted).real();
    ends_.bottomRightCorner(inner_ends_, inner_ends_) +=
        2 * (bin.inner_end.adjoint() * seen).real();
    for (Index r = 0; r < terms_; ++r)
      ends_.block(r * n, terms_ * n, n, inner_ends_) +=
          2 * (std::conj(bin.end[static_cast<std::size_t>(r)]) * seen).real();
  }
  if (inner_ends_ > 0) {  // inner ends are nearly collinear far below their frequencies
    ends_.bottomLeftCorner(inner_ends_, terms_ * n) =
        ends_.topRightCorner(terms_ * n, inner_ends_).transpose();
    ends_.diagonal() *= 1 + kRidge;
  }
  const ScaledCholesky factor(ends_);
  if (!factor.good()) return false;
  const VectorXd fitted = factor.solve(right);
  fitted_inner_ = fitted.tail(inner_ends_);
  for (Bin& bin : bins_) {
    for (Index r = 0; r < terms_; ++r)
      bin.residual -= bin.end[static_cast<std::size_t>(r)] * fitted.segment(r * n, n);
    if (inner_ends_ > 0) bin.residual -= bin.inner_end * fitted_inner_;
  }
  return true;
}

double SegmentLikelihood::sum_misfit() const {
  double sum = 0;
  for (const Bin& bin : bins_) sum += bin.residual.dot(bin.weight * bin.residual).real();
  return sum;
}

bool SegmentLikelihood::gather_all(LikelihoodPoint& point, bool exact_motion) const {
  point.gradient = VectorXd::Zero(parameters_);
  point.information = MatrixXd::Zero(parameters_, parameters_);
  point.noise_part = point.information;
  MatrixXd cross = MatrixXd::Zero(parameters_, end_unknowns());
  for (Index b = 0; b < spectrum_.bins(); ++b) {
    const Bin& bin = bins_[static_cast<std::size_t>(b)];
    const VectorXcd force = bin.weight * bin.residual;
    VectorXcd motion = spectrum_.accel.col(b);
    if (!exact_motion) motion -= noise_.asDiagonal() * (bin.operation.adjoint() * force);
    gather(b, force, motion, exact_motion, point, cross);
  }
  const ScaledCholesky factor(ends_);
  if (!factor.good()) return false;
  point.information -= cross * factor.solve(cross.transpose());
  return point.information.allFinite() && point.gradient.allFinite();
}

std::optional<double> SegmentLikelihood::misfit(const VectorXd& theta) {
  if (!prepare(theta)) return std::nullopt;
  const double sum = sum_misfit();
  return std::isfinite(sum) ? std::optional(sum) : std::nullopt;
}

std::optional<LikelihoodPoint> SegmentLikelihood::at(const VectorXd& theta) {
  LikelihoodPoint point;
  if (!prepare(theta) || !gather_all(point, false)) return std::nullopt;
  point.misfit = sum_misfit();
  return point;
}

std::optional<MatrixXd> SegmentLikelihood::information_of_exact_motion(const VectorXd& theta) {
  LikelihoodPoint point;
  if (!prepare(theta) || !gather_all(point, true)) return std::nullopt;
  return point.information;
}

}  // namespace framewatch::estimator
