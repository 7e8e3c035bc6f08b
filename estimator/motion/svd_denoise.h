// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// Parameters of the paper's noise removal by singular value decomposition, with the paper's
/// values.
struct SvdDenoising {
  int interval_rows = 200;   ///< p: samples of an interval
  int intervals = 5;         ///< q: intervals side by side
  double norm_ratio = 0.98;  ///< s(r): least share of the Frobenius norm that is kept

  int segment_rows() const { return interval_rows * intervals; }
};

/// Removes noise from one channel of a record, in segments of segment_rows() samples. The last
/// segment ends with the record; samples that two segments share are taken from the earlier one.
/// The channel needs at least segment_rows() samples, all finite. Serves for comparison with the
/// paper; the matched rows do not need it (docs/accuracy.md).
/// Source: docs/equations.md, removal of noise; P1 (22)-(27).
Eigen::VectorXd svd_denoised(const Eigen::VectorXd& samples, const SvdDenoising& denoising = {});

}  // namespace framewatch::estimator
