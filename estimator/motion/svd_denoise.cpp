#include "estimator/motion/svd_denoise.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/SVD>

namespace framewatch {
namespace {

/// The effective order r: the fewest singular values whose norm ratio reaches `norm_ratio`.
Eigen::Index effective_order(const Eigen::VectorXd& singular, double norm_ratio) {
  const double whole = singular.norm();
  Eigen::Index order = 1;
  while (order < singular.size() && singular.head(order).norm() < norm_ratio * whole) ++order;
  return order;
}

Eigen::MatrixXd low_rank(const Eigen::MatrixXd& a, double norm_ratio) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::Index r = effective_order(svd.singularValues(), norm_ratio);
  return svd.matrixU().leftCols(r) * svd.singularValues().head(r).asDiagonal() *
         svd.matrixV().leftCols(r).transpose();
}

}  // namespace

Eigen::VectorXd svd_denoised(const Eigen::VectorXd& samples, const SvdDenoising& denoising) {
  const Eigen::Index rows = denoising.stretch_rows();
  assert(rows > 0 && samples.size() >= rows && samples.allFinite());
  Eigen::VectorXd out(samples.size());
  for (Eigen::Index done = 0; done < samples.size();) {
    const Eigen::Index first = std::min(done, samples.size() - rows);
    const Eigen::MatrixXd stretch =
        samples.segment(first, rows).reshaped(denoising.interval_rows, denoising.intervals);
    const Eigen::VectorXd kept = low_rank(stretch, denoising.norm_ratio).reshaped();
    const Eigen::Index skipped = done - first;
    out.segment(done, rows - skipped) = kept.tail(rows - skipped);
    done = first + rows;
  }
  return out;
}

}  // namespace framewatch
