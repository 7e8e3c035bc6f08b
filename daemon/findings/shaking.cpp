#include "daemon/findings/shaking.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/motion/oscillator_section.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

using estimator::kNaN;

constexpr double kDamping = 0.7;
constexpr double kSettlePeriods = 2;  // of the corner
constexpr double kNoiseSigmas = 8;    // no noise reaches that within a year

/// RMS of the sensors' noise, as far as it is known.
double noise_mps2(const estimator::PipelineConfig& config) {
  double density = 0;
  for (const estimator::SensorAxis& axis : config.axes)
    density = std::max(density, axis.noise_density);
  return density * std::sqrt(config.options.rate_hz / 2);
}

}  // namespace

double Shake::drift_ratio() const {
  double most = 0;
  for (const StoryPeak& peak : story) most = std::max(most, peak.drift_ratio);
  return most;
}

Shaking::Shaking(const estimator::PipelineConfig& config)
    : config_(config),
      threshold_mps2_(std::max(kMoves_mps2, kNoiseSigmas * noise_mps2(config))),
      axis_of_(static_cast<std::size_t>(config.structure.degrees_of_freedom()), -1) {
  const double corner_hz = config.options.high_pass_hz, rate_hz = config.options.rate_hz;
  const estimator::OscillatorSection section(corner_hz, kDamping, rate_hz);
  const double w = 2 * std::numbers::pi * corner_hz;
  filter_ = {section.gain, section.a1, section.a2, (1 - section.a1 + section.a2) / 4, 1 / (w * w)};
  settle_ = static_cast<int>(std::ceil(kSettlePeriods * rate_hz / corner_hz));
  for (std::size_t a = 0; a < config.axes.size(); ++a)
    if (const estimator::SensorAxis& axis = config.axes[a]; axis.story > 0 && axis.frame >= 0)
      axis_of_[static_cast<std::size_t>(config.structure.dof(axis.story, axis.frame))] =
          static_cast<int>(a);
  reset();
}

void Shaking::reset() {
  axes_.assign(config_.axes.size(), {});
  accel_.assign(config_.axes.size(), kNaN);
  displacement_.assign(config_.axes.size(), kNaN);
}

double Shaking::Filter::high(double x, double in[2], double out[2]) const {
  const double y = high_gain * (x - 2 * in[0] + in[1]) - a1 * out[0] - a2 * out[1];
  in[1] = in[0], in[0] = x;
  out[1] = out[0], out[0] = y;
  return y;
}

double Shaking::Filter::integrated(double x, double x1, double x2, double out[2]) const {
  const double y = gain * (x + 2 * x1 + x2) / 4 - a1 * out[0] - a2 * out[1];
  out[1] = out[0], out[0] = y;
  return y * over_w2;
}

void Shaking::advance(std::size_t a, double accel, double base) {
  accel_[a] = displacement_[a] = kNaN;
  Axis& axis = axes_[a];
  if (!std::isfinite(accel) || !std::isfinite(base)) {
    axis = {};
    return;
  }
  const double relative = accel - base;
  if (axis.settled == 0) {
    std::fill_n(axis.in, 2, accel);
    std::fill_n(axis.relative_in, 2, relative);
  }
  const double high = filter_.high(accel, axis.in, axis.high);
  const double before[] = {axis.relative_high[0], axis.relative_high[1]};
  const double moved = filter_.high(relative, axis.relative_in, axis.relative_high);
  const double displacement = filter_.integrated(moved, before[0], before[1], axis.displacement);
  if (axis.settled < settle_) {
    ++axis.settled;
    return;
  }
  accel_[a] = high;
  displacement_[a] = displacement;
}

void Shaking::push(const estimator::SampleSet& instant) {
  const std::int64_t time_us = to_microseconds(instant.time);
  if (first_us_ == 0) first_us_ = time_us;
  if (instant.index != last_index_ + 1) reset();
  last_index_ = instant.index;
  double base[2] = {0, 0};
  int bases[2] = {0, 0};
  for (std::size_t a = 0; a < config_.axes.size(); ++a)
    if (config_.axes[a].story == 0) {
      const int d = config_.axes[a].direction == estimator::Direction::x ? 0 : 1;
      base[d] += instant.accel[a];
      ++bases[d];
    }
  for (std::size_t a = 0; a < config_.axes.size(); ++a) {
    const int d = config_.axes[a].direction == estimator::Direction::x ? 0 : 1;
    advance(a, instant.accel[a], bases[d] > 0 ? base[d] / bases[d] : kNaN);
  }
  const bool moving = moves();
  if (newest_ && !newest_->over && static_cast<double>(time_us - newest_->to_us) > 1e6 * kCalm_s) {
    newest_->over = true;
    if (!strongest_ || newest_->drift_ratio() > strongest_->drift_ratio()) strongest_ = newest_;
  }
  if (moving && (!newest_ || newest_->over)) {
    newest_.emplace();
    newest_->from_us = time_us;
    newest_->story.resize(static_cast<std::size_t>(config_.structure.stories));
  }
  if (moving) newest_->to_us = time_us;
  if (newest_ && !newest_->over) note(time_us);
}

bool Shaking::moves() const {
  return std::any_of(accel_.begin(), accel_.end(), [this](double accel) {
    return std::isfinite(accel) && std::abs(accel) > threshold_mps2_;
  });
}

void Shaking::note(std::int64_t time_us) {
  const estimator::Structure& s = config_.structure;
  Shake& shake = *newest_;
  for (std::size_t a = 0; a < accel_.size(); ++a) {
    double& peak = config_.axes[a].story == 0 ? shake.base_accel_mps2 : shake.floor_accel_mps2;
    if (std::isfinite(accel_[a])) peak = std::max(peak, std::abs(accel_[a]));
  }
  double shear[2] = {0, 0};
  for (int f = 0; f < s.frames(); ++f) {
    double below = 0;
    for (int story = 1; story <= s.stories; ++story) {
      const int a = axis_of_[static_cast<std::size_t>(s.dof(story, f))];
      const double at = a < 0 ? kNaN : displacement_[static_cast<std::size_t>(a)];
      const double accel = a < 0 ? kNaN : accel_[static_cast<std::size_t>(a)];
      const auto i = static_cast<std::size_t>(story - 1);
      const double ratio = std::abs(at - below) / s.story_height[i];
      if (ratio >= shake.story[i].drift_ratio) shake.story[i] = {ratio, f, time_us};
      below = at;
      shear[s.direction(f) == estimator::Direction::x ? 0 : 1] -= s.frame_mass(story, f) * accel;
    }
  }
  for (std::size_t d = 0; d < 2; ++d)
    if (std::isfinite(shear[d]))
      shake.base_shear_n[d] = std::max(shake.base_shear_n[d], std::abs(shear[d]));
}

const Shake* Shaking::strongest() const {
  if (!strongest_) return newest();
  if (newest_ && newest_->drift_ratio() > strongest_->drift_ratio()) return &*newest_;
  return &*strongest_;
}

}  // namespace framewatch::daemon
