#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// The paper's removal of noise by singular value decomposition, and its choice of the numbers.
struct SvdDenoising {
  int interval_rows = 200;   ///< p: samples in an interval
  int intervals = 5;         ///< q: intervals side by side
  double norm_ratio = 0.98;  ///< s(r): share of the Frobenius norm that is kept at least

  int segment_rows() const { return interval_rows * intervals; }
};

/// One channel of a record, noise removed: segments of segment_rows() samples, the last one ending
/// with the record (what two segments share is taken from the earlier). For comparison with the
/// paper; the matched rows do without (docs/accuracy.md).
/// Precondition: at least segment_rows() samples, all finite.
/// Source: docs/equations.md, removal of noise; P1 (22)-(27).
Eigen::VectorXd svd_denoised(const Eigen::VectorXd& samples, const SvdDenoising& denoising = {});

}  // namespace framewatch::estimator
