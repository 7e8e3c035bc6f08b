#pragma once

#include <limits>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// One axis of a plot.
struct SvgAxis {
  std::string label;                                      ///< quantity and unit: "stiffness, kN/m"
  double low = std::numeric_limits<double>::quiet_NaN();  ///< NaN: from the data
  double high = std::numeric_limits<double>::quiet_NaN();
  bool logarithmic = false;                  ///< only values > 0 are drawn
  std::vector<std::string> categories = {};  ///< names at 1, 2, ... instead of numbers
};

struct SvgTick {
  double value;
  std::string label;
};

/// The axis with both ends. An end that is NaN is set a little beyond `values` (NaN and infinite
/// ones are ignored), or half a category beyond the first or last category.
SvgAxis fitted(SvgAxis axis, const std::vector<double>& values);

/// Round numbers (1, 2 or 5 times a power of ten) between the ends, about `wanted` of them;
/// logarithmic: powers of ten; categories: one each.
std::vector<SvgTick> ticks(const SvgAxis& axis, int wanted);

/// Position of a value on a fitted axis: 0 at low, 1 at high; NaN when it cannot be drawn.
double position(const SvgAxis& axis, double value);

}  // namespace framewatch::daemon
