#include "estimator/diagnose/fit/operations.h"

#include <utility>

#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Operations::Operations(const MatrixXd& mass, const MatrixXd& stiffness, const MatrixXd& damping,
                       std::vector<LinearOperation> additions, VectorXd w)
    : mass_(mass),
      stiffness_(stiffness),
      damping_(damping),
      additions_(std::move(additions)),
      w_(std::move(w)) {
  constexpr Index kMaxKept = 1'000'000;  // numbers
  const Index bins = w_.size();
  if (mass_.size() * bins > kMaxKept) return;
  for (Index b = 0; b < bins; ++b) kept_.push_back(made(b));
}

MatrixXcd Operations::times(const MatrixXcd& motion) const {
  return product(motion, false);
}

MatrixXcd Operations::adjoint_times(const MatrixXcd& forces) const {
  return product(forces, true);
}

MatrixXcd Operations::of_axis(Index axis) const {
  MatrixXcd out(equations(), w_.size());
  for (Index b = 0; b < out.cols(); ++b) {
    if (!kept_.empty() || !additions_.empty()) {
      out.col(b) = (*this)[static_cast<std::size_t>(b)].col(axis);
      continue;
    }
    out.col(b).real() = mass_.col(axis) - stiffness_.col(axis) / (w_[b] * w_[b]);
    out.col(b).imag() = damping_.col(axis) / -w_[b];
  }
  return out;
}

MatrixXcd Operations::made(Index bin) const {
  const double w = w_[bin];
  MatrixXcd out(mass_.rows(), mass_.cols());
  out.real() = mass_ - stiffness_ / (w * w);
  out.imag() = damping_ / -w;
  for (const LinearOperation& addition : additions_) addition.add_to(w, out);
  return out;
}

MatrixXcd Operations::product(const MatrixXcd& columns, bool adjoint) const {
  const Index bins = w_.size();
  // Real parts of all bins, then imaginary parts: one real product for each matrix.
  RowMatrix parts = RowMatrix::Zero(columns.rows(), padded(static_cast<int>(2 * bins)));
  parts.leftCols(bins) = columns.real();
  parts.middleCols(bins, bins) = columns.imag();
  const auto times_parts = [&](const MatrixXd& matrix) {
    RowMatrix out;
    multiply(adjoint ? RowMatrix(matrix.transpose()) : RowMatrix(matrix), parts, out);
    return out;
  };
  const RowMatrix inert = times_parts(mass_), elastic = times_parts(stiffness_),
                  viscous = times_parts(damping_);
  MatrixXcd out(inert.rows(), bins);
  for (Index b = 0; b < bins; ++b) {
    const double square = w_[b] * w_[b], w = adjoint ? -w_[b] : w_[b];
    out.col(b).real() = inert.col(b) - elastic.col(b) / square + viscous.col(bins + b) / w;
    out.col(b).imag() = inert.col(bins + b) - elastic.col(bins + b) / square - viscous.col(b) / w;
  }
  for (const LinearOperation& addition : additions_) addition.add_times(w_, columns, adjoint, out);
  return out;
}

}  // namespace framewatch::estimator
