#include "estimator/shaking/shaking_watch.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numbers>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kDamping = 0.7;
constexpr double kMeanShare = 0.1;    // corner of the mean, over that of the displacement
constexpr double kSettlePeriods = 2;  // of the corner
constexpr std::size_t kBefore = 12, kEnds = 3;

double seconds(Time from, Time to) {
  return std::chrono::duration<double>(to - from).count();
}

BaselineLearner any_windows(std::size_t parameters) {
  return BaselineLearner(std::vector<Watched>(parameters), std::numeric_limits<double>::infinity());
}

/// The larger of two, where the first may be none.
void raise(double& peak, double value) {
  if (!(value <= peak)) peak = value;
}

}  // namespace

double ShakenStiffness::std_error() const {
  return std::hypot(after.std_error, after.value / before.value * before.std_error) /
         std::abs(before.value);
}

ShakingWatch::Windows::Windows(std::size_t most_, std::size_t parameters)
    : most(most_),
      start(most_),
      end(most_),
      value(most_ * parameters, kNaN),
      std_error(most_ * parameters, kNaN) {}

void ShakingWatch::Windows::put(const WindowEstimate& e, std::size_t parameters) {
  if (count == most) {
    std::rotate(start.begin(), start.begin() + 1, start.end());
    std::rotate(end.begin(), end.begin() + 1, end.end());
    const auto step = static_cast<std::ptrdiff_t>(parameters);
    for (std::vector<double>* of : {&value, &std_error})
      std::rotate(of->begin(), of->begin() + step, of->end());
    --count;
  }
  start[count] = e.start;
  end[count] = e.end;
  for (std::size_t p = 0; p < parameters; ++p) {
    const bool shown = e.reason[p] == Observability::observable;
    value[count * parameters + p] = shown ? e.value[p] : kNaN;
    std_error[count * parameters + p] = shown ? e.std_error[p] : kNaN;
  }
  ++count;
}

WindowMean ShakingWatch::Windows::mean(std::size_t p, std::size_t parameters) const {
  std::vector<WindowValue> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back({start[i], end[i], value[i * parameters + p], std_error[i * parameters + p]});
  return mean_of(values, 0, values.size());
}

ShakingWatch::ShakingWatch(const Structure& structure, const std::vector<SensorAxis>& axes,
                           const EstimatorOptions& estimation, const ShakingOptions& options)
    : structure_(structure),
      axes_(axes),
      elements_(static_cast<std::size_t>(ParameterTable(structure).elements())),
      rate_hz_(estimation.rate_hz),
      corner_hz_(estimation.high_pass_hz),
      options_(options),
      section_(corner_hz_, kDamping, rate_hz_),
      axis_of_dof_(static_cast<std::size_t>(structure.degrees_of_freedom()), -1),
      motions_(axes.size()),
      now_(axes.size(), kNaN),
      moved_(axes.size(), kNaN),
      accel_(axes.size(), kNaN),
      drift_(axis_of_dof_.size(), kNaN),
      before_(kBefore, elements_),
      first_(kEnds, elements_),
      final_(kEnds, elements_),
      after_(kEnds, elements_),
      during_(any_windows(2 * elements_)) {
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].story == 0)
      base_axes_.push_back(static_cast<int>(a));
    else if (axes[a].frame >= 0)
      axis_of_dof_[static_cast<std::size_t>(structure.dof(axes[a].story, axes[a].frame))] =
          static_cast<int>(a);
  }
}

/// The axis' acceleration without its mean; its displacement goes to moved_.
double ShakingWatch::follow(std::size_t axis, double accel) {
  Motion& m = motions_[axis];
  moved_[axis] = kNaN;
  if (!std::isfinite(accel)) {
    m = {};
    return kNaN;
  }
  if (m.settled_s < 0) {
    m.mean = accel;
    m.settled_s = 0;
  }
  m.mean += 2 * std::numbers::pi * kMeanShare * corner_hz_ / rate_hz_ * (accel - m.mean);
  const double x = accel - m.mean;
  const double s =
      section_.gain * (x + 2 * m.x1 + m.x2) / 4 - section_.a1 * m.s1 - section_.a2 * m.s2;
  m.x2 = m.x1;
  m.x1 = x;
  m.s2 = m.s1;
  m.s1 = s;
  m.settled_s += 1 / rate_hz_;
  if (m.settled_s * corner_hz_ >= kSettlePeriods)
    moved_[axis] = s / std::pow(2 * std::numbers::pi * corner_hz_, 2);
  return x;
}

bool ShakingWatch::push(const SampleSet& set, const Baseline* baseline) {
  began_ = false;
  if (set.index != next_index_) std::fill(motions_.begin(), motions_.end(), Motion{});
  next_index_ = set.index + 1;
  double most = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    now_[a] = std::abs(follow(a, set.accel[a]));
    if ((base_axes_.empty() || axes_[a].story == 0) && now_[a] > most) most = now_[a];
  }
  const bool strong = most > options_.trigger_mps2;
  if (strong && !active_) begin(set.time);
  if (!active_) return false;
  if (strong) {
    last_ = set.time;
    after_.count = 0;
  }
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (std::isfinite(now_[a])) raise(accel_[a], now_[a]);
  take_peaks();
  const bool over = seconds(last_, set.time) >= options_.quiet_s;
  if (!over && seconds(start_, set.time) < kLongest_s) return false;
  active_ = false;
  if (seconds(start_, last_) < kShortest_s) return false;
  finish(set.time, baseline);
  return true;
}

void ShakingWatch::begin(Time now) {
  active_ = began_ = true;
  start_ = last_ = now;
  std::fill(accel_.begin(), accel_.end(), kNaN);
  std::fill(drift_.begin(), drift_.end(), kNaN);
  first_.count = final_.count = after_.count = 0;
  during_ = any_windows(2 * elements_);
  gap_ = kNaN;
}

void ShakingWatch::take_peaks() {
  for (int story = 1; story <= structure_.stories; ++story)
    for (int f = 0; f < structure_.frames(); ++f) {
      const auto dof = static_cast<std::size_t>(structure_.dof(story, f));
      const int above = axis_of_dof_[dof];
      if (above < 0) continue;
      double below = 0;
      if (story > 1) {
        const int axis = axis_of_dof_[static_cast<std::size_t>(structure_.dof(story - 1, f))];
        below = axis < 0 ? kNaN : moved_[static_cast<std::size_t>(axis)];
      } else {
        double count = 0;
        for (const int a : base_axes_)
          if (axes_[static_cast<std::size_t>(a)].direction == structure_.direction(f)) {
            below += moved_[static_cast<std::size_t>(a)];
            ++count;
          }
        below = count > 0 ? below / count : kNaN;
      }
      const double drift = std::abs(moved_[static_cast<std::size_t>(above)] - below);
      if (std::isfinite(drift)) raise(drift_[dof], drift);
    }
}

void ShakingWatch::push(const WindowEstimate& e) {
  if (e.window != 0 || e.status != WindowStatus::valid) return;
  if (!active_) {
    if (!before_.overlaps(e)) before_.put(e, elements_);
    return;
  }
  if (e.start < start_) return;
  (void)during_.push(e);
  if (e.start >= last_) {
    if (after_.count < kEnds && !after_.overlaps(e)) after_.put(e, elements_);
  } else if (first_.count < kEnds) {
    if (!first_.overlaps(e)) first_.put(e, elements_);
  } else if (!first_.overlaps(e) && !final_.overlaps(e)) {
    final_.put(e, elements_);
  }
}

void ShakingWatch::gap(double nrmse) {
  if (active_ && std::isfinite(nrmse)) raise(gap_, nrmse);
}

void ShakingWatch::finish(Time now, const Baseline* baseline) {
  ended_ = {start_, last_, now, accel_, drift_, {}, gap_};
  const Baseline during = during_.so_far();
  for (std::size_t p = 0; p < elements_; ++p) {
    ShakenStiffness s;
    if (baseline != nullptr && baseline->knows(p)) {
      s.before = {baseline->value[p], baseline->std_error[p], 1};
      s.before_from = BeforeFrom::baseline;
    } else if (const WindowMean m = before_.mean(p, elements_); m.count > 0) {
      s.before = m;
      s.before_from = BeforeFrom::windows_before;
    } else if (const WindowMean f = first_.mean(p, elements_); f.count > 0) {
      s.before = f;
      s.before_from = BeforeFrom::first_windows;
    }
    if (during.knows(p)) s.during = {during.value[p], during.std_error[p], 1};
    s.after = after_.mean(p, elements_);
    s.free = s.after.count > 0;
    if (!s.free) s.after = final_.mean(p, elements_);
    ended_.stiffness.push_back(s);
  }
  before_.count = 0;
}

}  // namespace framewatch::estimator
