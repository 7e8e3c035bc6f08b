// SPDX-License-Identifier: MIT
#include "daemon/tools/session/axis_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr double kSettled_s = 1, kMemory_s = 5;

constexpr double kPulse_s = 0.25, kRest_s = 0.3, kRinging_s = 1;
constexpr double kOverRinging = 2.5, kClear = 0.8, kFirst = 0.5;

// Limits beyond which a user should check the channel before the table moves.
constexpr double kMaxWhite = 2;        // rms over that of its noise; beyond it the building moves
constexpr double kMaxNoise = 3;        // times the configured density
constexpr double kMaxOffset_mps2 = 1;  // 6 degrees of tilt
constexpr double kMaxMissing_ratio = 0.01;
constexpr double kNearRange = 0.9;

}  // namespace

RestLevel::RestLevel(std::size_t axes, double rate_hz)
    : settled_(std::lround(kSettled_s * rate_hz)),
      memory_(std::lround(kMemory_s * rate_hz)),
      axes_(axes),
      distance_(axes) {}

const std::vector<double>& RestLevel::push(const estimator::SampleSet& set) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    const double value = set.accel[a];
    distance_[a] = std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(value)) continue;
    if (axis.seen >= settled_) distance_[a] = value - axis.mean;
    axis.seen = std::min(axis.seen + 1, memory_);
    axis.mean += (value - axis.mean) / static_cast<double>(axis.seen);
  }
  return distance_;
}

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
  if (r.stuck > 0 || r.rms == 0) return "stuck: its value stands still";
  if (static_cast<double>(r.missing) > kMaxMissing_ratio * static_cast<double>(sets_))
    return fmt::format("{:.1f} % of its samples are missing",
                       100 * static_cast<double>(r.missing) / static_cast<double>(sets_));
  if (r.range > 0 && r.peak > kNearRange * r.range)
    return fmt::format("{:.0f} % of its range is used", 100 * r.peak / r.range);
  const bool moves = r.rms > kMaxWhite * r.noise_density * std::sqrt(rate_hz_ / 2);
  if (!moves && configured > 0 && r.noise_density > kMaxNoise * configured)
    return fmt::format("noise {:.1f} times the configured one", r.noise_density / configured);
  if (std::abs(r.offset) > kMaxOffset_mps2)
    return fmt::format("rests at {:+.2f} m/s^2: level it or configure its offset", r.offset);
  return "";
}

}  // namespace framewatch::daemon
