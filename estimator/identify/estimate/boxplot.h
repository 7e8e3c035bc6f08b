// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/identify/estimate/estimate.h"

namespace framewatch::estimator {

/// Exact boxplot of one parameter over the last `windows` windows, as MATLAB draws it. Sorted value
/// i has probability (i - 0.5)/n, linear in between. Outliers lie strictly beyond 1.5 interquartile
/// ranges; whiskers end at the most extreme values that are not outliers. Values that are not
/// finite take a place but do not count. Without windows, there are no statistics.
class BoxplotWindow {
 public:
  explicit BoxplotWindow(int windows);

  void reset();
  void push(double value);
  BoxplotStatistics statistics() const;

  void archive(auto& a) {
    a(ring_, sorted_, guide_);
    a.within(next_, 0, static_cast<double>(ring_.size()));
    a.within(count_, 0, static_cast<double>(ring_.size()));
    if (!consistent()) a.refuse();
  }

 private:
  double quartile(std::size_t q) const;
  /// Returns true if the sorted values are those of the ring.
  bool consistent() const;

  std::vector<double> ring_;    ///< in order of arrival; infinite values do not count
  std::vector<double> sorted_;  ///< ascending; infinite after the values that count
  std::vector<double> guide_;   ///< every kGuideStep-th sorted value, see kernels.h
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace framewatch::estimator
