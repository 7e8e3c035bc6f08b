// SPDX-License-Identifier: MIT
#include "estimator/watch/change_detector.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr Time kLongAgo{SensorClock::duration(-8'000'000'000'000'000)};
constexpr double kFreedom = 19;        // of a window's standard error, from 20 blocks
constexpr double kMemory_s = 15;       // of the usual standard error
constexpr double kMaxOfUsual = 1.5;    // largest weight of a single one, over the usual one
constexpr double kBaselineErrors = 3;  // of the baseline, tolerated as a permanent offset
constexpr double kMaxOfThreshold = 2;  // largest sum, over the threshold
constexpr double kConvincing_s = 4;    // a shorter window adds little:
constexpr double kShortWindow = 0.6;   // the most it adds, over the threshold
constexpr std::array<double, ChangeDetector::kSizes> kSizesOfLeast = {1, 2, 4, 16};

double log_likelihood(double z, double freedom) {
  return -(freedom + 1) / 2 * std::log1p(z * z / freedom);
}

}  // namespace

ChangeDetector::ChangeDetector(const Baseline& baseline, const std::vector<Watched>& watched,
                               double threshold)
    : baseline_(baseline), threshold_(threshold), parameters_(watched.size()) {
  for (std::size_t p = 0; p < watched.size(); ++p) parameters_[p].watched = watched[p];
  used_until_.fill(kLongAgo);
}

int ChangeDetector::free_phase(const WindowEstimate& e) const {
  const auto length = e.end - e.start;
  const auto phases = used_until_.begin() + kPhases;
  const Time newest = *std::max_element(used_until_.begin(), phases);
  if (e.end < newest) return used_until_[kPhases] <= e.start ? kPhases : -1;
  if (newest != kLongAgo && e.end - newest < length / kPhases) return -1;
  const auto free =
      std::find_if(used_until_.begin(), phases, [&](Time until) { return until <= e.start; });
  return free == phases ? -1 : static_cast<int>(free - used_until_.begin());
}

void ChangeDetector::push(const WindowEstimate& e, const std::vector<std::uint8_t>& held) {
  const int phase = free_phase(e);
  if (phase < 0) return;
  used_until_[static_cast<std::size_t>(phase)] = e.end;
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    const Watched& watched = parameters_[p].watched;
    if (!held.empty() && held[p] != 0) continue;
    if (watched.least_change > 0 && baseline_.knows(p) && watched.counts(e, p)) judge(p, phase, e);
  }
}

void ChangeDetector::forget(std::size_t p) {
  Parameter& parameter = parameters_[p];
  parameter.sign = parameter.phase = parameter.size = 0;
  parameter.back.fill(0);
  for (auto& tracks : parameter.away) tracks.fill({});
}

double ChangeDetector::evidence(int parameter, int sign) const {
  double most = 0;
  for (const Tracks& tracks : of(parameter).away[sign < 0 ? 0 : 1])
    for (const Track& track : tracks) most = std::max(most, track.sum);
  return most / (sign < 0 ? threshold_ : kGain * threshold_);
}

void ChangeDetector::judge(std::size_t p, int phase, const WindowEstimate& e) {
  Parameter& parameter = parameters_[p];
  const double error = e.std_error[p] / baseline_.value[p];
  const double baseline_error = baseline_.std_error[p] / baseline_.value[p];
  const double window_s = seconds_of(e.end - e.start);
  double& usual = parameter.usual_error;
  // Windows across a change have large errors; they must not hide the next ones.
  const double most = kMaxOfUsual * usual;
  const double share =
      std::max(window_s / kPhases / kMemory_s, 1 / static_cast<double>(++parameter.errors));
  usual += std::min(1.0, share) * ((usual == 0 ? error : std::min(error, most)) - usual);
  const double scale = std::hypot(std::max(error, usual), baseline_error);
  const double off = e.value[p] / baseline_.value[p] - 1;
  const double tolerance =
      (parameter.watched.tolerance + parameter.tolerated + kBaselineErrors * baseline_error) /
      scale;
  const double z = off / scale, least = parameter.watched.least_change / scale;

  // The error is at least the usual one, which is averaged over so many windows.
  const double freedom = kFreedom * (1 + kMemory_s / window_s);
  const auto likelihood = [&](double distance) { return log_likelihood(distance, freedom); };

  for (const int sign : {-1, 1}) {
    const double threshold = sign < 0 ? threshold_ : kGain * threshold_;
    const double most_gain =
        (window_s < kConvincing_s ? kShortWindow : kMaxOfThreshold) * threshold;
    const double toward = sign * z;
    const double unchanged = likelihood(toward - std::clamp(toward, 0.0, tolerance));
    for (int size = 0; size < kSizes; ++size) {
      const auto i = static_cast<std::size_t>(size);
      Track& track = parameter.away[sign < 0 ? 0 : 1][static_cast<std::size_t>(phase)][i];
      const double gain =
          std::min(likelihood(toward - kSizesOfLeast[i] * least) - unchanged, most_gain);
      if (track.sum + gain <= 0) {
        track = {};
        continue;
      }
      if (track.sum == 0) track.since = e.start;
      track.sum = std::min(track.sum + gain, kMaxOfThreshold * threshold);
      track.weight += 1 / (scale * scale);
      track.off += off / (scale * scale);
      if (parameter.sign != 0 || track.sum <= threshold) continue;
      parameter.sign = sign;
      parameter.phase = phase;
      parameter.size = size;
      parameter.back.fill(0);
    }
  }
  if (parameter.sign == 0) return;
  double& back = parameter.back[static_cast<std::size_t>(phase)];
  const double toward = parameter.sign * z;
  back = std::max(0.0, back + likelihood(toward - std::clamp(toward, 0.0, tolerance)) -
                           likelihood(toward - std::max(toward, least)));
  if (back <= threshold_) return;
  parameter.sign = 0;
  for (auto& tracks : parameter.away) tracks.fill({});
}

Change ChangeDetector::change(int parameter) const {
  const Parameter& p = of(parameter);
  const auto u = static_cast<std::size_t>(parameter);
  const Track& track = p.away[p.sign < 0 ? 0 : 1][static_cast<std::size_t>(p.phase)]
                             [static_cast<std::size_t>(p.size)];
  if (track.weight <= 0) return {};
  return {track.off / track.weight,
          std::hypot(1 / std::sqrt(track.weight), baseline_.std_error[u] / baseline_.value[u]),
          track.since, track.since, track.since};
}

}  // namespace framewatch::estimator
