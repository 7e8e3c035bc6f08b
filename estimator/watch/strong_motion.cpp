#include "estimator/watch/strong_motion.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {
namespace {

constexpr double kMean_hz = 0.03;  // corner of the mean: far below what shakes a building

}  // namespace

StrongMotion::StrongMotion(const std::vector<SensorAxis>& axes, double rate_hz)
    : mean_step_(2 * std::numbers::pi * kMean_hz / rate_hz) {
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].story == 0 && axes[a].horizontal()) axes_.push_back(a);
  for (std::size_t a = 0; a < axes.size() && (axes_.empty() || axes[axes_[0]].story != 0); ++a)
    if (axes[a].horizontal()) axes_.push_back(a);
  mean_.assign(axes_.size(), 0);
  seen_.assign(axes_.size(), 0);
}

void StrongMotion::push(const SampleSet& set) {
  double most = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double accel = set.accel[axes_[i]];
    if (!std::isfinite(accel)) continue;
    ++seen_[i];
    mean_[i] += std::max(mean_step_, 1 / seen_[i]) * (accel - mean_[i]);
    most = std::max(most, std::abs(accel - mean_[i]));
  }
  if (most <= kTrigger_mps2) return;
  const bool goes_on = any_ && std::chrono::duration<double>(set.time - last_).count() < kCalm_s;
  peak_ = goes_on ? std::max(peak_, most) : most;
  any_ = true;
  last_ = set.time;
}

}  // namespace framewatch::estimator
