// SPDX-License-Identifier: MIT
#include "estimator/shaking/shaking_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {
namespace {

constexpr std::size_t kBefore = 12, kEnds = 3;

}  // namespace

double ShakenStiffness::std_error() const {
  return record.measured() ? record.change.std_error : ratio_error(before, after);
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

ShakingWatch::ShakingWatch(const PipelineConfig& config, const ShakingOptions& options)
    : elements_(static_cast<std::size_t>(config.parameters().elements())),
      options_(options),
      trigger_axes_(shaken_axes(config.axes)),
      response_(config),
      peak_(config.axes.size(), static_cast<std::size_t>(config.structure.degrees_of_freedom())),
      before_(kBefore, elements_),
      first_(kEnds, elements_),
      final_(kEnds, elements_),
      after_(kEnds, elements_),
      late_(kEnds, elements_),
      during_(BaselineLearner::of_any_windows(2 * elements_)) {}

bool ShakingWatch::push(const SampleSet& set, const Baseline* baseline) {
  began_ = false;
  response_.push(set);
  // An instant without any value counts as an interruption.
  if (std::none_of(set.accel.begin(), set.accel.end(), [](double a) { return std::isfinite(a); }))
    return false;
  const bool missed = note_interruption(set.time);
  // Motion after so long an interruption counts as another one.
  if (active_ && missed && seconds_of(set.time - start_) >= kLongest_s)
    return end(set.time, baseline);
  const bool strong = std::any_of(trigger_axes_.begin(), trigger_axes_.end(), [this](auto axis) {
    return std::abs(response_.accel_mps2()[axis]) > options_.trigger_mps2;
  });
  if (strong && !active_) begin(set.time);
  if (!active_) return false;
  if (strong) {
    last_ = set.time;
    unheard_calm_s_ = 0;
    after_.count = 0;
  }
  peak_.take(response_);
  const bool over = seconds_of(set.time - last_) - unheard_calm_s_ >= options_.quiet_s;
  if (!over && seconds_of(set.time - start_) < kLongest_s) return false;
  return end(set.time, baseline);
}

bool ShakingWatch::end(Time now, const Baseline* baseline) {
  active_ = false;
  const bool long_enough = seconds_of(last_ - start_) >= kShortest_s;
  if (long_enough) finish(now, baseline);
  // The next strong motion may begin in the newest interruption.
  if (unheard_count_ > 1) unheard_[0] = unheard_[unheard_count_ - 1];
  unheard_count_ = std::min<std::size_t>(unheard_count_, 1);
  return long_enough;
}

void ShakingWatch::came_up(Time known, bool raw) {
  came_up_ = CameUp{known, raw};
}

/// Returns true if an interruption ended just before this instant.
bool ShakingWatch::note_interruption(Time now) {
  const bool first = !std::exchange(heard_any_, true);
  const Time before = std::exchange(heard_, now);
  const UnheardWhy restart =
      came_up_ && came_up_->raw ? UnheardWhy::restart : UnheardWhy::restart_no_raw;
  if (first) {
    if (came_up_) add_unheard({now, now, false, restart});
    return false;
  }
  const double missing_s = seconds_of(now - before);
  if (missing_s <= kUnheard_s) return false;
  const bool restarted = came_up_ && before <= came_up_->known && came_up_->known <= now;
  add_unheard({before, now, true, restarted ? restart : UnheardWhy::no_samples});
  unheard_calm_s_ += missing_s;
  return true;
}

void ShakingWatch::add_unheard(const Unheard& unheard) {
  if (!active_) unheard_count_ = 0;
  if (unheard_count_ == kMaxUnheard) {
    Unheard& last = unheard_[kMaxUnheard - 1];
    last.to = unheard.to;
    last.why = std::max(last.why, unheard.why);
    return;
  }
  unheard_[unheard_count_++] = unheard;
}

void ShakingWatch::begin(Time now) {
  active_ = began_ = true;
  start_ = last_ = now;
  peak_ = PeakResponse(peak_.accel_mps2.size(), peak_.drift_m.size());
  first_.count = final_.count = after_.count = late_.count = 0;
  during_ = BaselineLearner::of_any_windows(2 * elements_);
  gap_ = kNaN;
  unheard_calm_s_ = 0;
  if (unheard_count_ > 0 && seconds_of(now - unheard_[0].to) >= options_.quiet_s)
    unheard_count_ = 0;
}

void ShakingWatch::push(const WindowEstimate& e) {
  if (e.late) return push_late(e);
  response_.follow(e);
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

/// Takes the motion's first windows when they arrive late, after the filters were tuned.
void ShakingWatch::push_late(const WindowEstimate& e) {
  if (!active_ || e.window != 0 || e.status != WindowStatus::valid || e.start < start_) return;
  if (late_.count == kEnds || late_.overlaps(e)) return;
  if (first_.count > 0 && e.end > first_.start.front()) return;
  late_.put(e, elements_);
}

WindowMean ShakingWatch::first_mean(std::size_t p) const {
  const WindowMean late = late_.mean(p, elements_);
  return late.count > 0 ? late : first_.mean(p, elements_);
}

void ShakingWatch::push_gap(double nrmse) {
  if (active_ && std::isfinite(nrmse) && !(nrmse <= gap_)) gap_ = nrmse;
}

void ShakingWatch::finish(Time now, const Baseline* baseline) {
  ended_ = {start_, last_, now, peak_, {}, gap_, response_.knowledge(), {}, response_.settling_s()};
  ended_.unheard.assign(unheard_.begin(),
                        unheard_.begin() + static_cast<std::ptrdiff_t>(unheard_count_));
  const Baseline during = during_.so_far();
  for (std::size_t p = 0; p < elements_; ++p) {
    ShakenStiffness s;
    if (baseline != nullptr && baseline->knows(p)) {
      s.before = {baseline->value[p], baseline->std_error[p], 1};
      s.before_from = BeforeFrom::baseline;
    } else if (const WindowMean m = before_.mean(p, elements_); m.count > 0) {
      s.before = m;
      s.before_from = BeforeFrom::windows_before;
    } else if (const WindowMean f = first_mean(p); f.count > 0) {
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
