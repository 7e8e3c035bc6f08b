// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "estimator/numeric/quantile.h"

namespace framewatch::daemon {

/// Returns a share in percent with two or three digits: "0.061 %", "12 %", "-" for NaN, "> 1000 %".
std::string percent(double share);
/// Returns a share in percent with one decimal: "94.3 %". For shares that are compared with a
/// limit.
std::string percent_1(double share);

/// Returns the median of the values without NaN: the upper one of two middle values. Returns NaN if
/// no value is left.
inline double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  return estimator::upper_median(values);
}

/// Returns "25.02 ± 0.14": the error with two digits, the value with the same decimals.
std::string with_error(double value, double std_error);
/// Returns "-25.0 ± 0.1": a change in percent. The error is at least 0.1.
std::string change_with_error(double ratio, double std_error);

}  // namespace framewatch::daemon
