#pragma once

#include <cstddef>

#include "estimator/identify/estimate/estimate.h"

namespace framewatch::estimator {

/// By what limits a parameter is watched.
struct Watched {
  double least_change = 0;  ///< least relevant change, relative; 0: not watched
  double most_bias = 1;     ///< share of prior and noise above which a value does not count
  double tolerance = 0;     ///< lasting deviation, relative, that is no change

  /// Whether a window has a value that is learned from and judged. The bias of prior and noise is
  /// the same in all windows alike, so that no mean removes it.
  bool counts(const WindowEstimate& e, std::size_t p) const {
    return e.reason[p] == Observability::observable && e.std_error[p] > 0 &&
           e.prior_share[p] + e.noise_share[p] <= most_bias;
  }
};

}  // namespace framewatch::estimator
