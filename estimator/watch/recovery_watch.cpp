// SPDX-License-Identifier: MIT
#include "estimator/watch/recovery_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {
namespace {

constexpr double kMean_hz = 0.03;  // corner of the mean: far below what shakes a building

constexpr double kLawHolds_s = 86400;
constexpr double kRemember = 0.05;  // weight of the newest window in the usual amplitude

}  // namespace

StrongMotion::StrongMotion(const std::vector<SensorAxis>& axes, double rate_hz)
    : axes_(shaken_axes(axes)), mean_step_(2 * std::numbers::pi * kMean_hz / rate_hz) {
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
  const bool goes_on = any_ && seconds_of(set.time - last_) < kCalm_s;
  peak_ = goes_on ? std::max(peak_, most) : most;
  any_ = true;
  last_ = set.time;
}

RecoveryWatch::RecoveryWatch(const Watch& watch, const WatchOptions& options)
    : usual_m_(static_cast<std::size_t>(watch.parameters()), 0.0) {
  // A group's least change is half of a story's; the watch knows which elements are groups.
  recoveries_.assign(usual_m_.size(), Recovery(options.least_change_k));
  due_.reserve(usual_m_.size());
}

void RecoveryWatch::begin(Time ended) {
  ended_ = ended;
  for (Recovery& r : recoveries_) r.begin(ended);
}

const Recovery* RecoveryWatch::of(int parameter) const {
  if (parameter < 0 || static_cast<std::size_t>(parameter) >= recoveries_.size()) return nullptr;
  const Recovery& r = recoveries_[static_cast<std::size_t>(parameter)];
  return r.windows() > 0 ? &r : nullptr;
}

void RecoveryWatch::push(const WindowEstimate& e, bool long_window, const Watch& watch,
                         const StrongMotion& strong) {
  due_.clear();
  if ((e.window != 0 && !long_window) || e.status != WindowStatus::valid) return;
  if (strong.any() && strong.last() != ended_ && e.start >= strong.last()) {
    const double since_s = seconds_of(strong.last() - ended_);
    if (peak_mps2_ == 0 || since_s > kLawHolds_s ||
        strong.peak_mps2() >= kAftershock * peak_mps2_) {
      peak_mps2_ = strong.peak_mps2();
      begin(strong.last());
    }
  }
  const bool shaken = strong.any() && e.start < strong.last();
  for (std::size_t p = 0; p < recoveries_.size(); ++p) {
    if (!watch.watched(p) || e.reason[p] != Observability::observable) continue;
    if (!shaken && !long_window && !recoveries_[p].active() && e.amplitude[p] > 0)
      usual_m_[p] += (usual_m_[p] > 0 ? kRemember : 1) * (e.amplitude[p] - usual_m_[p]);
    if (shaken || !recoveries_[p].active()) continue;
    long_window ? take_long(p, e, watch) : take(p, e, watch);
    if (recoveries_[p].renewal_due(e.end)) due_.push_back(static_cast<int>(p));
  }
}

void RecoveryWatch::take(std::size_t p, const WindowEstimate& e, const Watch& watch) {
  const Baseline* baseline = watch.baseline();
  if (baseline == nullptr || !baseline->knows(p) || !(e.amplitude[p] > 0)) return;
  const AmplitudeCurve& curve = watch.curve(p);
  const double usual_m = usual_m_[p] > 0 ? usual_m_[p] : e.amplitude[p];
  recoveries_[p].push(recovery_window(e.start, e.end, e.value[p], e.std_error[p], e.amplitude[p],
                                      baseline->value[p], baseline->std_error[p], curve, usual_m));
}

void RecoveryWatch::take_long(std::size_t p, const WindowEstimate& e, const Watch& watch) {
  const Baseline* baseline = watch.quiet_baseline();
  if (baseline == nullptr || !baseline->knows(p)) return;
  const Dependence::Expected intact =
      watch.dependence().expected(p, {watch.degc(e.end), DependenceLearner::log_amplitude(e, p)});
  if (!std::isfinite(intact.std_error) || !(intact.ratio > 0)) return;
  const double value = baseline->value[p] * intact.ratio;
  RecoveryWindow w{e.start, e.end, e.value[p] / value - 1, e.std_error[p] / value, 0, 0, 1};
  w.baseline_error = std::hypot(baseline->std_error[p] / baseline->value[p], intact.std_error);
  recoveries_[p].push(w);
}

}  // namespace framewatch::estimator
