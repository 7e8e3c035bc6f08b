#include "daemon/tools/session/tap_test.h"

#include <algorithm>
#include <cmath>

namespace framewatch::daemon {
namespace {

constexpr double kPulse_s = 0.25, kRest_s = 0.3, kRinging_s = 1;
constexpr double kOverRinging = 2.5, kClear = 0.8, kFirst = 0.5;

}  // namespace

TapTest::TapTest(std::size_t axes, double rate_hz)
    : pulse_(std::max(2L, std::lround(kPulse_s * rate_hz))),
      rest_(std::lround(kRest_s * rate_hz)),
      forget_(std::exp(-1 / (kRinging_s * rate_hz))),
      ringing_(axes, 0.0) {}

std::optional<TapTest::Tap> TapTest::push(const std::vector<double>& distance,
                                          const std::vector<double>& threshold) {
  const std::size_t axes = ringing_.size();
  const auto beyond = [&](std::size_t a) {
    return std::abs(distance[a]) > std::max(threshold[a], kOverRinging * ringing_[a]);
  };
  if (since_ < 0)
    for (std::size_t a = 0; a < axes; ++a)
      if (beyond(a)) since_ = 0;
  std::optional<Tap> found;
  if (since_ >= 0 && since_ < pulse_) {
    pulse_rows_.push_back(distance);
    if (++since_ < pulse_) return std::nullopt;
    found = judge();
    pulse_rows_.clear();
  } else if (since_ >= 0 && ++since_ >= pulse_ + rest_) {
    since_ = -1;
  }
  for (std::size_t a = 0; a < axes; ++a)
    if (std::isfinite(distance[a]))
      ringing_[a] = std::max(std::abs(distance[a]), forget_ * ringing_[a]);
  return found;
}

TapTest::Tap TapTest::judge() const {
  std::vector<double> peak(ringing_.size(), 0.0);
  for (const std::vector<double>& row : pulse_rows_)
    for (std::size_t a = 0; a < peak.size(); ++a)
      if (std::isfinite(row[a])) peak[a] = std::max(peak[a], std::abs(row[a]));
  const auto largest = std::max_element(peak.begin(), peak.end());
  const auto axis = static_cast<std::size_t>(largest - peak.begin());
  for (std::size_t a = 0; a < peak.size(); ++a)
    if (a != axis && peak[a] > kClear * *largest) return {-1, 0, *largest};
  for (const std::vector<double>& row : pulse_rows_)
    if (std::abs(row[axis]) >= kFirst * *largest)
      return {static_cast<int>(axis), row[axis] > 0 ? 1 : -1, *largest};
  return {-1, 0, *largest};
}

}  // namespace framewatch::daemon
