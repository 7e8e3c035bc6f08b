// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// One parameter in one of several windows that do not overlap; NaN: it has no value there.
struct WindowValue {
  Time start, end;
  double value = 0, std_error = 0;
};

/// A mean weighted with 1 / std_error^2. Its error follows from the weights, or from the scatter if
/// that is larger, and from the errors of the weights.
struct WindowMean {
  double value = 0, std_error = 0;
  int count = 0;
};
/// Returns the standard error of the ratio of `after` to `before`.
double ratio_error(const WindowMean& before, const WindowMean& after);
/// Returns the mean of values `from` to `to` - 1; NaN if none of them has a value.
WindowMean mean_of(const std::vector<WindowValue>& values, std::size_t from, std::size_t to);

/// A lasting change within a series of windows, found afterwards.
struct ChangePoint {
  std::size_t before_end = 0;   ///< windows 0 .. before_end - 1 are before it
  std::size_t after_begin = 0;  ///< windows from here on are after it; one between may have both
  WindowMean before, after;

  double ratio() const { return after.value / before.value - 1; }
  double std_error() const { return ratio_error(before, after); }  ///< of ratio()
  double errors() const;                                           ///< size over its standard error
};

/// Returns the most significant division of a series into two parts with different means. The
/// window between the parts belongs to neither. At least two windows lie behind a change, and four
/// in both parts. Returns nullopt when the change is below `least_change`, relative, or below
/// kChangeErrors standard errors, or when a straight line describes the series about as well.
std::optional<ChangePoint> find_change(const std::vector<WindowValue>& values, double least_change);

/// Noise divides a session of some hundred parameters and windows by so many errors with a
/// probability below 0.1 %.
constexpr double kChangeErrors = 6;

}  // namespace framewatch::estimator
