#include "daemon/base/svg_axis.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr double kMargin = 0.04;  ///< beyond the data, share of their range

/// The largest of 1, 2, 5 times a power of ten that makes at least `wanted` steps of a range.
double round_step(double range, int wanted) {
  const double raw = range / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= raw) return factor * power;
  return power;
}

std::string number(double value, double step) {
  const double size = std::max(std::abs(value), step);
  if (size >= 1e6 || step < 1e-5) return fmt::format("{:.6g}", value);
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", std::abs(value) < 1e-9 * step ? 0.0 : value, decimals);
}

std::vector<SvgTick> powers_of_ten(const SvgAxis& axis, int wanted) {
  const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  const int every = std::max(1, (last - first + wanted) / wanted);
  std::vector<SvgTick> out;
  for (int power = first; power <= last; power += every) {
    const double value = std::pow(10.0, power);
    out.push_back(
        {value, std::abs(power) <= 4 ? fmt::format("{:g}", value) : fmt::format("1e{}", power)});
  }
  return out;
}

}  // namespace

SvgAxis fitted(SvgAxis axis, const std::vector<double>& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!axis.categories.empty()) {
    low = 0.5;
    high = static_cast<double>(axis.categories.size()) + 0.5;
  } else if (low > high) {
    low = axis.logarithmic ? 0.1 : 0.0;
    high = 1;
  } else if (axis.logarithmic) {
    low /= 1.5;
    high *= 1.5;
  } else {
    if (!std::isnan(axis.low)) low = axis.low;
    if (!std::isnan(axis.high)) high = axis.high;
    const double range = high > low ? high - low : std::max(1e-12, std::abs(high));
    low -= kMargin * range;
    high += kMargin * range;
  }
  if (std::isnan(axis.low)) axis.low = low;
  if (std::isnan(axis.high)) axis.high = high;
  if (!(axis.high > axis.low)) axis.high = axis.low + std::max(1e-12, std::abs(axis.low));
  return axis;
}

std::vector<SvgTick> ticks(const SvgAxis& axis, int wanted) {
  std::vector<SvgTick> out;
  if (!axis.categories.empty()) {
    for (std::size_t i = 0; i < axis.categories.size(); ++i)
      out.push_back({static_cast<double>(i + 1), axis.categories[i]});
    return out;
  }
  if (axis.logarithmic) return powers_of_ten(axis, wanted);
  const double step = round_step(axis.high - axis.low, wanted);
  const double first = std::ceil(axis.low / step - 1e-9);
  const double last = std::floor(axis.high / step + 1e-9);
  for (double i = first; i <= last; ++i) out.push_back({i * step, number(i * step, step)});
  return out;
}

double position(const SvgAxis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return value > 0 ? std::log(value / axis.low) / std::log(axis.high / axis.low)
                   : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace framewatch::daemon
