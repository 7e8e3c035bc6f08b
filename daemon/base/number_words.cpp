#include "daemon/base/number_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr int kMaxDecimals = 6;
constexpr double kMinPercent = 0.1;

}  // namespace

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
