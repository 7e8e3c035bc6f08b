#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// A share as text in per cent with two or three digits: "0.061 %", "12 %", "-" for NaN, "> 1000
/// %".
std::string percent(double share);
/// A share in per cent with one decimal: "94.3 %", for shares that are compared with a limit.
std::string percent_1(double share);

/// Median of the values that are not NaN; of two in the middle the upper one. NaN when there are
/// none.
inline double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return NAN;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// "25.02 ± 0.14": two digits of the error, and the value to the same place.
std::string with_error(double value, double std_error);
/// "-25.0 ± 0.1": a change in %, to the tenth that no error is below.
std::string change_with_error(double ratio, double std_error);

}  // namespace framewatch::daemon
