#pragma once

#include <vector>

#include "estimator/identify/estimate/estimate.h"

namespace framewatch::estimator {

/// Exact boxplot of one parameter over the last `windows` windows, as MATLAB draws it: sorted value
/// i at probability (i - 0.5)/n, linear between; outliers strictly beyond 1.5 interquartile ranges;
/// whiskers at the most extreme values that are none. Values that are not finite take a place but
/// do not count. No windows: no statistics.
class BoxplotWindow {
 public:
  explicit BoxplotWindow(int windows);

  void reset();
  void push(double value);
  BoxplotStatistics statistics() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(ring_, sorted_, guide_);
    a.within(next_, 0, static_cast<double>(ring_.size()));
    a.within(count_, 0, static_cast<double>(ring_.size()));
    if (!consistent()) a.refuse();
  }

 private:
  double quartile(std::size_t q) const;
  /// Whether the sorted values are those of the ring.
  bool consistent() const;

  std::vector<double> ring_;    ///< in order of arrival; infinite: does not count
  std::vector<double> sorted_;  ///< ascending, infinite beyond the values that count
  std::vector<double> guide_;   ///< every kGuideStep-th of them: see kernels.h
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace framewatch::estimator
