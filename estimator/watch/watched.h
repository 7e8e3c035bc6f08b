#pragma once

#include <cstddef>

#include "estimator/identify/estimate.h"

namespace framewatch {

/// How a parameter is watched.
struct Watched {
  double smallest = 0;   ///< change that matters, relative; 0: not watched
  double most_pull = 1;  ///< share of prior and noise in a value above which it does not count
  double spare = 0;      ///< lasting error, relative, that values may have all the same

  /// Whether a window has a value that is learned from and judged. What prior and noise pull far
  /// toward the design is off by the same in every window like it, so that no mean finds it.
  bool counts(const WindowEstimate& e, std::size_t p) const {
    return e.reason[p] == Observability::observable &&
           e.prior_share[p] + e.noise_share[p] <= most_pull;
  }
};

}  // namespace framewatch
