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

/// A weighted mean (1 / std_error^2). Its error follows from the weights, or from the scatter if
/// that is larger.
struct WindowMean {
  double value = 0, std_error = 0;
  int count = 0;
};
/// Of values `from` to `to` - 1; NaN without any.
WindowMean mean_of(const std::vector<WindowValue>& values, std::size_t from, std::size_t to);

/// A lasting change inside of a series of windows, seen afterwards.
struct ChangePoint {
  std::size_t before_end = 0;   ///< windows 0 .. before_end - 1 are before it
  std::size_t after_begin = 0;  ///< windows from here on are after it; one between may have both
  WindowMean before, after;

  double ratio() const { return after.value / before.value - 1; }
  double std_error() const;  ///< of ratio()
  double errors() const;     ///< size over its standard error
};

/// The most significant division of a series into two parts with different means; none when it is
/// below `least_change`, relative, or below kChangeErrors standard errors, or when a straight line
/// describes the series about as well. The window between the parts belongs to neither. At least
/// two windows lie behind a change, and four in both parts.
std::optional<ChangePoint> find_change(const std::vector<WindowValue>& values, double least_change);

/// Of a division: the chance that noise makes one as large anywhere in a session of some hundred
/// parameters and windows is below 0.1 %.
constexpr double kChangeErrors = 6;

}  // namespace framewatch::estimator
