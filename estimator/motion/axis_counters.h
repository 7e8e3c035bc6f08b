// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace framewatch::estimator {

/// Counts the samples of one axis by what happened to them.
struct AxisCounters {
  std::int64_t received = 0;  ///< all samples of the axis
  std::int64_t missing = 0;   ///< instants closed without a value, or while all values stopped
  std::int64_t late = 0;      ///< arrived after their instant was closed
  std::int64_t repaired = 0;  ///< single losses filled by interpolation
  std::int64_t stuck = 0;     ///< removed: the value did not change while the building moved
  std::int64_t clipped = 0;   ///< removed: at the end of the sensor's range
  std::int64_t rejected = 0;  ///< NaN, absurd, duplicate, off the grid or far from the others
  std::int64_t absurd = 0;    ///< part of `rejected`: values that no sensor can have measured

  /// Archives the state, as every archive() does: estimator/state/archive.h.
  void archive(auto& a) {
    for (std::int64_t* count :
         {&received, &missing, &late, &repaired, &stuck, &clipped, &rejected, &absurd})
      a.within(*count, 0, a.kMaxCount);
  }
};

}  // namespace framewatch::estimator
