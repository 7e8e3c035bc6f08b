#include "estimator/diagnose/weights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/structure/complex.h"

namespace framewatch {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kEndTerms = 4;

Weights::Weights(std::vector<MatrixXcd> whitener, const VectorXd& w,
                 std::vector<HiddenOscillator> hidden)
    : whitener_(std::move(whitener)),
      relative_(w / std::sqrt(w[0] * w[w.size() - 1])),
      hidden_(std::move(hidden)) {
  const Index n = equations();
  scale_ = VectorXd::Ones(kEndTerms * n + 2 * static_cast<Index>(hidden_.size()));
  Gram gram(ends());
  for (Index b = 0; b < bins(); ++b) {
    put_ends(b, gram.rows(2 * n));
    gram.add();
  }
  MatrixXd square = gram.sum();
  scale_ = square.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  square = scale_.asDiagonal() * square * scale_.asDiagonal();
  square.diagonal().array() += 1e-12;
  factor_.compute(square);
}

void Weights::put_ends(Index bin, Eigen::Ref<RowMatrix, 0, Eigen::OuterStride<>> out) const {
  const MatrixXcd& whitener = this->whitener(bin);
  const Index n = whitener.rows();
  const double r = relative_[bin];
  const auto re = whitener.real();
  const auto im = whitener.imag();
  out.topRows(n).leftCols(n) = re / (r * r);
  out.bottomRows(n).leftCols(n) = im / (r * r);
  out.topRows(n).middleCols(n, n) = im / r;  // 1/(j r)
  out.bottomRows(n).middleCols(n, n) = -re / r;
  out.topRows(n).middleCols(2 * n, n) = re;
  out.bottomRows(n).middleCols(2 * n, n) = im;
  out.topRows(n).middleCols(3 * n, n) = -im * r;
  out.bottomRows(n).middleCols(3 * n, n) = re * r;
  Index column = kEndTerms * n;
  for (const HiddenOscillator& h : hidden_) {
    const VectorXcd at = whitener * (h.direction * h.passes[bin]);
    out.col(column).head(n) = at.real();
    out.col(column).tail(n) = at.imag();
    out.col(column + 1).head(n) = -at.imag() * r;
    out.col(column + 1).tail(n) = at.real() * r;
    column += 2;
  }
  out.array().rowwise() *= scale_.transpose().array();
}

VectorXd Weights::without_ends(const VectorXd& rows) const {
  const Index n = equations();
  RowMatrix here(2 * n, ends());
  VectorXd along = VectorXd::Zero(ends());
  for (Index b = 0; b < bins(); ++b) {
    put_ends(b, here);
    along.noalias() += here.transpose() * rows.segment(2 * n * b, 2 * n);
  }
  const VectorXd size = factor_.solve(along);
  VectorXd out = rows;
  for (Index b = 0; b < bins(); ++b) {
    put_ends(b, here);
    out.segment(2 * n * b, 2 * n).noalias() -= here * size;
  }
  return out;
}

}  // namespace framewatch
