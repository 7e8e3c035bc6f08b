#include "daemon/monitor/event_report/response_words.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/core.h>

namespace framewatch::daemon {

std::string force_words(double newton) {
  constexpr const char* kUnits[] = {"N", "kN", "MN", "GN"};
  double value = newton;
  std::size_t unit = 0;
  for (; std::abs(value) >= 999.5 && unit + 1 < std::size(kUnits); ++unit) value /= 1000;
  return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

std::string drift_words(double ratio) {
  const double percent = 100 * ratio;
  const int before = percent > 0 ? static_cast<int>(std::floor(std::log10(percent))) + 1 : 1;
  return fmt::format("{:.{}f} %", percent, std::clamp(3 - before, 0, 9));
}

std::string base_shear_words(const estimator::PeakResponse& peak,
                             const estimator::Structure& structure) {
  std::string out;
  for (std::size_t d = 0; d < 2; ++d) {
    if ((d == 0 ? structure.n() : structure.m()) == 0) continue;
    const double shear = peak.base_shear_n[d];
    out += fmt::format("{}{} along {}", out.empty() ? "" : ", ",
                       std::isfinite(shear) ? force_words(shear) : "not known", d == 0 ? "x" : "y");
  }
  return out;
}

}  // namespace framewatch::daemon
