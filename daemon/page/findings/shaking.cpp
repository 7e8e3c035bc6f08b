// SPDX-License-Identifier: MIT
#include "daemon/page/findings/shaking.h"

#include <algorithm>
#include <cmath>

namespace framewatch::daemon {
namespace {

constexpr double kNoiseSigmas = 8;  // noise does not reach it within a year

/// Returns the rms of the sensors' noise; unknown noise counts as zero.
double noise_mps2(const estimator::PipelineConfig& config) {
  double density = 0;
  for (const estimator::SensorAxis& axis : config.axes)
    if (!axis.is_force) density = std::max(density, axis.noise_density);
  return density * std::sqrt(config.options.rate_hz / 2);
}

}  // namespace

Shaking::Shaking(const estimator::PipelineConfig& config)
    : config_(config),
      threshold_mps2_(std::max(kMoves_mps2, kNoiseSigmas * noise_mps2(config))),
      response_(config) {}

void Shaking::push(const estimator::SampleSet& instant) {
  const std::int64_t time_us = to_microseconds(instant.time);
  if (first_us_ == 0) first_us_ = time_us;
  response_.push(instant);
  const bool moving = moves();
  if (newest_ && !newest_->over && static_cast<double>(time_us - newest_->to_us) > 1e6 * kCalm_s) {
    newest_->over = true;
    if (!strongest_ || drift_ratio(*newest_) > drift_ratio(*strongest_)) strongest_ = newest_;
  }
  if (moving && (!newest_ || newest_->over)) {
    const auto dofs = static_cast<std::size_t>(config_.structure.degrees_of_freedom());
    newest_ = Shake{time_us, time_us, false, {config_.axes.size(), dofs}};
  }
  if (moving) newest_->to_us = time_us;
  if (newest_ && !newest_->over) newest_->peak.take(response_);
}

bool Shaking::moves() const {
  const std::vector<double>& accel = response_.accel_mps2();
  return std::any_of(accel.begin(), accel.end(),
                     [this](double of) { return std::abs(of) > threshold_mps2_; });
}

const std::vector<estimator::StoryDrift>& Shaking::drifts() const {
  if (newest_ && newest_->to_us != drifts_until_us_) {
    drifts_ = story_drifts(config_, newest_->peak, response_.knowledge());
    drifts_until_us_ = newest_->to_us;
  }
  return drifts_;
}

double Shaking::drift_ratio(const Shake& shake) const {
  return estimator::largest_drift_ratio(shake.peak, config_.structure);
}

const Shake* Shaking::strongest() const {
  if (!strongest_) return newest();
  if (newest_ && drift_ratio(*newest_) > drift_ratio(*strongest_)) return &*newest_;
  return &*strongest_;
}

}  // namespace framewatch::daemon
