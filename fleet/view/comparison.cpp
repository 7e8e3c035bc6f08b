#include "fleet/view/comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace framewatch::fleet {
namespace {

constexpr double kOfNormal = 1.4826;  // standard deviation over median absolute deviation
constexpr double kByChance = 0.05;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

Level level_of(std::span<const float> medians, std::span<const float> std_errors) {
  if (medians.empty()) return {};
  Level out;
  out.periods = static_cast<int>(medians.size());
  out.value = median_of({medians.begin(), medians.end()});
  std::vector<double> away;
  for (const float m : medians) away.push_back(std::abs(static_cast<double>(m) - out.value));
  double squares = 0;
  for (const float e : std_errors) squares += static_cast<double>(e) * static_cast<double>(e);
  const auto periods = static_cast<double>(medians.size());
  const double s = std::max(std::sqrt(squares / periods), kOfNormal * median_of(std::move(away)));
  out.std_error = std::sqrt(0.5 * std::numbers::pi / periods) * s;
  return out;
}

void compare(Comparison& c) {
  c.compared = c.before.periods > 0 && c.after.periods > 0 && c.before.value > 0;
  if (!c.compared) return;
  c.ratio = c.after.value / c.before.value - 1;
  c.std_error = std::hypot(c.after.std_error / c.before.value,
                           c.after.value * c.before.std_error / (c.before.value * c.before.value));
}

double significant_errors(std::size_t comparisons) {
  const double chance = kByChance / static_cast<double>(std::max<std::size_t>(comparisons, 1));
  double low = 0, high = 40;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::numbers::sqrt2) > chance ? low : high) = middle;
  }
  return high;
}

}  // namespace framewatch::fleet
