#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace framewatch::daemon {

/// Median of the values that are not NaN; of two in the middle the upper one. NaN when there are
/// none.
inline double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return NAN;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace framewatch::daemon
