// SPDX-License-Identifier: MIT
#include "estimator/motion/svd_denoise.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "estimator/numeric/eigenvalues.h"

namespace framewatch::estimator {
namespace {

/// The effective order r: the fewest singular values whose norm ratio reaches `norm_ratio`.
Eigen::Index effective_order(const Eigen::VectorXd& singular, double norm_ratio) {
  const double whole = singular.norm();
  Eigen::Index order = 1;
  while (order < singular.size() && singular.head(order).norm() < norm_ratio * whole) ++order;
  return order;
}

Eigen::MatrixXd low_rank(const Eigen::MatrixXd& a, double norm_ratio) {
  const SingularValues svd = singular_values(a);
  const Eigen::Index r = effective_order(svd.values, norm_ratio);
  return svd.left.leftCols(r) * svd.values.head(r).asDiagonal() * svd.right.leftCols(r).transpose();
}

}  // namespace

Eigen::VectorXd svd_denoised(const Eigen::VectorXd& samples, const SvdDenoising& denoising) {
  const Eigen::Index rows = denoising.segment_rows();
  assert(rows > 0 && samples.size() >= rows && samples.allFinite());
  Eigen::VectorXd out(samples.size());
  for (Eigen::Index done = 0; done < samples.size();) {
    const Eigen::Index first = std::min(done, samples.size() - rows);
    const Eigen::MatrixXd segment =
        samples.segment(first, rows).reshaped(denoising.interval_rows, denoising.intervals);
    const Eigen::VectorXd kept = low_rank(segment, denoising.norm_ratio).reshaped();
    const Eigen::Index skipped = done - first;
    out.segment(done, rows - skipped) = kept.tail(rows - skipped);
    done = first + rows;
  }
  return out;
}

}  // namespace framewatch::estimator
