#pragma once

#include <vector>

#include "estimator/identify/estimate.h"

namespace framewatch {

/// Exact boxplot of one parameter over the last `windows` windows, as MATLAB draws it: sorted value
/// i at probability (i - 0.5)/n, linear between; outliers strictly beyond 1.5 interquartile ranges;
/// whiskers at the most extreme values that are none. NaN values take a place but do not count.
/// No windows: no statistics.
class BoxplotWindow {
 public:
  explicit BoxplotWindow(int windows);

  void reset();
  void push(double value);
  BoxplotStatistics statistics() const;

 private:
  double quantile(double probability) const;

  std::vector<double> ring_;    ///< in order of arrival, NaN among them
  std::vector<double> sorted_;  ///< the values that count, ascending
  std::size_t next_ = 0;
};

}  // namespace framewatch
