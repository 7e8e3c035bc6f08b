#include "estimator/watch/watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace framewatch {
namespace {

constexpr double kSeconds = 3600;
constexpr double kNewsErrors = 2;  // standard errors a change moves by before it is told again

/// A design off by its tolerance may not move a value by more than this share of the change that
/// matters. A panel's change that matters is one or two standard errors of its values, so that what
/// moves them all alike must be allowed for; a frame's is many.
constexpr double kMostPull_k = 0.1, kMostPull_g = 0.25;

std::vector<Watched> what_is_watched(const ParameterTable& table, const WatchOptions& o) {
  const auto watched = [](double smallest, double pull, ParameterKind kind, double spare) {
    return Watched{smallest, smallest * pull / design_tolerance(kind), smallest * spare};
  };
  std::vector<Watched> out(static_cast<std::size_t>(table.size()));
  for (std::size_t p = 0; p < out.size(); ++p) {
    const ParameterKind kind = table[static_cast<int>(p)].kind;
    if (kind == ParameterKind::frame_stiffness)
      out[p] = watched(o.smallest_k, kMostPull_k, kind, 0);
    if (kind == ParameterKind::panel_stiffness)
      out[p] = watched(o.smallest_g, kMostPull_g, kind, kMostPull_g);
  }
  return out;
}

/// Sums that may cross it, per year, over the false alarms that are put up with:
/// docs/equations.md (41).
double threshold_for(const WatchOptions& o, const std::vector<double>& windows_s,
                     const std::vector<Watched>& watched) {
  const auto count = static_cast<double>(std::count_if(
      watched.begin(), watched.end(), [](const Watched& w) { return w.smallest > 0; }));
  double per_second = 0;
  for (const double s : windows_s) per_second += 2 * count * ChangeDetector::kPhases / s;
  const double tests = per_second * kSeconds * o.shaking_hours_per_year;
  return std::log(std::max(tests / o.alarms_per_year, 2.0));
}

}  // namespace

Watch::Watch(const ParameterTable& table, const WatchOptions& options,
             const std::vector<double>& windows_s, std::optional<Baseline> baseline)
    : options_(options),
      watched_(what_is_watched(table, options)),
      windows_s_(windows_s),
      threshold_(threshold_for(options, windows_s, watched_)),
      learner_(table.size(), options.learn_s),
      baseline_(std::move(baseline)),
      states_(watched_.size()) {
  detectors_.reserve(windows_s.size());
  news_.reserve(watched_.size());
  if (baseline_) begin();
}

void Watch::begin() {
  detectors_.clear();
  for (std::size_t i = 0; i < windows_s_.size(); ++i)
    detectors_.emplace_back(*baseline_, watched_, threshold_);
}

const std::vector<Alarm>& Watch::push(const WindowEstimate& estimate) {
  news_.clear();
  if (!baseline_) {
    if (!learner_.push(estimate)) return news_;
    baseline_ = learner_.baseline();
    begin();
    return news_;
  }
  const auto window = static_cast<std::size_t>(estimate.window);
  if (window >= detectors_.size()) return news_;
  detectors_[window].push(estimate);
  for (int p = 0; p < static_cast<int>(states_.size()); ++p) tell(p, estimate);
  return news_;
}

void Watch::tell(int parameter, const WindowEstimate& estimate) {
  State& state = states_[static_cast<std::size_t>(parameter)];
  const auto window = static_cast<std::size_t>(estimate.window);
  const bool changed = detectors_[window].changed(parameter);
  if (state.id == 0) {
    if (!changed) return;
    state = {++last_id_, window, detectors_[window].change(parameter)};
    news_.push_back({state.id, AlarmState::raised, parameter, state.told, estimate.end});
    return;
  }
  if (state.detector != window) return;
  if (!changed) {
    news_.push_back({state.id, AlarmState::cleared, parameter, state.told, estimate.end});
    state = {};
    return;
  }
  const Change now = detectors_[window].change(parameter);
  if (std::abs(now.ratio - state.told.ratio) < kNewsErrors * state.told.std_error) return;
  state.told = now;
  news_.push_back({state.id, AlarmState::changed, parameter, now, estimate.end});
}

}  // namespace framewatch
