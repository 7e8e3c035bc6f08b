#include "daemon/base/percent.h"

#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {

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

}  // namespace framewatch::daemon
