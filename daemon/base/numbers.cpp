// SPDX-License-Identifier: MIT
#include "daemon/base/numbers.h"

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr int kMaxDecimals = 6;
constexpr double kMinPercent = 0.1;

}  // namespace

std::string percent(double share) {
  const double value = 100 * share;
  if (std::isnan(value)) return "-";
  if (std::abs(value) > 1000) return value > 0 ? "> 1000 %" : "< -1000 %";
  if (std::abs(value) >= 10) return fmt::format("{:.0f} %", value);
  return fmt::format("{:.2g} %", value);
}

std::string percent_1(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:.1f} %", 100 * share);
}

std::string with_error(double value, double std_error) {
  const int decimals =
      std_error > 0
          ? std::clamp(1 - static_cast<int>(std::floor(std::log10(std_error))), 0, kMaxDecimals)
          : 3;
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, std_error, decimals);
}

std::string change_with_error(double ratio, double std_error) {
  const double tenths = std::round(1000 * ratio) / 10 + 0.0;  // no "-0.0"
  return fmt::format("{:+.1f} ± {:.1f}", tenths, std::max(kMinPercent, 100 * std_error));
}

}  // namespace framewatch::daemon
