#include "daemon/tools/session/axis_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

// Beyond these a person should look before the table moves.
constexpr double kMaxWhite = 2;        // rms over that of its noise; beyond it the building moves
constexpr double kMaxNoise = 3;        // times the configured density
constexpr double kMaxOffset_mps2 = 1;  // 6 degrees of tilt
constexpr double kMaxMissing_ratio = 0.01;
constexpr double kNearRange = 0.9;

}  // namespace

std::string channels_text(const std::vector<ChannelResult>& results) {
  std::string out =
      fmt::format("{:<16} {:>22} {:>12} {:>12} {:>9}  {}\n", "channel", "noise, um/s^2/sqrt(Hz)",
                  "rms, m/s^2", "rests at", "saturated", "");
  for (const ChannelResult& r : results)
    out += fmt::format(
        "{:<16} {:>22} {:>12.2g} {:>+12.4f} {:>9}  {}\n", r.name,
        std::isfinite(r.noise_density) ? fmt::format("{:.3g}", 1e6 * r.noise_density) : "?", r.rms,
        r.offset, r.saturated,
        !r.problem.empty() ? r.problem
        : r.polarity > 0   ? "polarity right"
                           : "");
  return out;
}

ChannelCheck::ChannelCheck(const std::vector<estimator::SensorAxis>& axes, double rate_hz)
    : axes_(axes),
      rate_hz_(rate_hz),
      noise_(static_cast<int>(axes.size()), rate_hz),
      sums_(axes.size()),
      before_(axes.size()) {}

void ChannelCheck::begin(const std::vector<estimator::AxisCounters>& counters) {
  sets_ = 0;
  sums_.assign(sums_.size(), {});
  before_ = counters;
}

void ChannelCheck::push(const estimator::SampleSet& set) {
  ++sets_;
  noise_.push(set.accel);
  for (std::size_t a = 0; a < sums_.size(); ++a) {
    Sums& s = sums_[a];
    const double value = set.accel[a];
    if (!std::isfinite(value)) {
      ++s.missing;
      continue;
    }
    if (s.samples++ == 0) s.first = s.lowest = s.highest = value;
    s.sum += value - s.first;
    s.squares += (value - s.first) * (value - s.first);
    s.lowest = std::min(s.lowest, value);
    s.highest = std::max(s.highest, value);
  }
}

std::vector<ChannelResult> ChannelCheck::results(
    const std::vector<estimator::AxisCounters>& counters) const {
  std::vector<ChannelResult> out;
  for (std::size_t a = 0; a < sums_.size(); ++a) {
    const Sums& s = sums_[a];
    ChannelResult r;
    r.name = axes_[a].name;
    r.range = axes_[a].range;
    r.samples = s.samples;
    r.missing = s.missing;
    r.saturated = counters[a].clipped - before_[a].clipped;
    r.stuck = counters[a].stuck - before_[a].stuck;
    const double density = noise_.density(static_cast<int>(a));
    r.noise_density = density > 0 ? density : std::numeric_limits<double>::quiet_NaN();
    if (s.samples > 0) {
      const auto count = static_cast<double>(s.samples);
      const double mean = s.sum / count;
      r.offset = s.first + mean;
      r.rms = std::sqrt(std::max(0.0, s.squares / count - mean * mean));
      r.peak = std::max(std::abs(s.lowest), std::abs(s.highest));
    }
    r.problem = problem(a, r);
    out.push_back(std::move(r));
  }
  return out;
}

std::string ChannelCheck::problem(std::size_t a, const ChannelResult& r) const {
  const double configured = axes_[a].noise_density;
  if (r.samples == 0) return r.saturated > 0 ? "saturated: every sample" : "no samples";
  if (r.saturated > 0) return fmt::format("saturated: {} samples", r.saturated);
  if (r.stuck > 0 || r.rms == 0) return "its value stands still";
  if (static_cast<double>(r.missing) > kMaxMissing_ratio * static_cast<double>(sets_))
    return fmt::format("{:.1f} % of its samples are missing",
                       100 * static_cast<double>(r.missing) / static_cast<double>(sets_));
  if (r.range > 0 && r.peak > kNearRange * r.range)
    return fmt::format("{:.0f} % of its range is used", 100 * r.peak / r.range);
  const bool moves = r.rms > kMaxWhite * r.noise_density * std::sqrt(rate_hz_ / 2);
  if (!moves && configured > 0 && r.noise_density > kMaxNoise * configured)
    return fmt::format("noise {:.1f} times what is configured", r.noise_density / configured);
  if (std::abs(r.offset) > kMaxOffset_mps2)
    return fmt::format("rests at {:+.2f} m/s^2: not level, or an offset to configure", r.offset);
  return "";
}

}  // namespace framewatch::daemon
