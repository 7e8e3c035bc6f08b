#include "estimator/watch/watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch::estimator {
namespace {

/// Of a story's least relevant change: what a group of several in series shows of a larger one.
constexpr double kOfGroup = 0.5;
constexpr double kSeconds = 3600, kHoursPerYear = 8766;
constexpr double kBinsPerWindow = 20, kBin_s = 60;  // of the temperature's means
constexpr double kExpectedErrors = 3;
/// Motion of late counts, for long windows, from so many times the usual amplitude on.
constexpr double kStrong = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnknown_degc = 10;       // assumed deviation while the thermometer is silent
constexpr double kMostBendingError = 0.1;  // relative, of windows to learn from
constexpr double kNewsErrors = 2;  // standard errors a change moves by before it is reported again
constexpr double kSharper = 0.7;   // of the error reported: a smaller one is news too

/// A design off by its tolerance may not bias a value by more than this share of the least relevant
/// change. For a panel that is one or two standard errors of its values, so that a bias common to
/// all windows must be allowed for; for a frame it is many.
constexpr double kMostBias_k = 0.1, kMostBias_g = 0.25;
/// The same in long windows, whose baseline has the same bias.
constexpr double kMostBiasQuiet = 0.4;

DependenceOptions quiet_options(const WatchOptions& o) {
  return {kSeconds * o.quiet_learn_hours, o.temperature, o.amplitude};
}

/// From the number of tests per year over the accepted false alarms: docs/equations.md (41).
double threshold_for(const WatchOptions& o, const std::vector<double>& windows_s,
                     const std::vector<Watched>& watched) {
  const auto count = static_cast<double>(std::count_if(
      watched.begin(), watched.end(), [](const Watched& w) { return w.least_change > 0; }));
  const double tests_per_window = 2 * count * ChangeDetector::kPhases * ChangeDetector::kSizes;
  double tests = 0;
  for (const double s : windows_s)
    tests += tests_per_window * kSeconds * o.shaking_hours_per_year / s;
  if (o.quiet_window_s > 0) tests += tests_per_window * kSeconds * kHoursPerYear / o.quiet_window_s;
  const double wald = std::log(std::max(tests / o.alarms_per_year, 2.0));
  return std::max(wald - ChangeDetector::kOvershoot, std::log(2.0));
}

}  // namespace

std::vector<Watched> watched_parameters(const ParameterTable& table, const WatchOptions& o) {
  const auto watched = [](double least_change, double bias, ParameterKind kind, double tolerance) {
    if (least_change == 0) return Watched{};
    return Watched{least_change, least_change * bias / design_tolerance(kind),
                   least_change * tolerance};
  };
  std::vector<Watched> out(static_cast<std::size_t>(table.size()));
  for (std::size_t p = 0; p < out.size(); ++p) {
    const ParameterKind kind = table[static_cast<int>(p)].kind;
    const bool group = table[static_cast<int>(p)].last_story > table[static_cast<int>(p)].story;
    if (kind == ParameterKind::frame_stiffness)
      out[p] = watched((group ? kOfGroup : 1) * o.least_change_k, kMostBias_k, kind, 0);
    if (kind == ParameterKind::panel_stiffness)
      out[p] = watched(o.least_change_g, kMostBias_g, kind, kMostBias_g);
  }
  return out;
}

Watch::Watch(const ParameterTable& table, const WatchOptions& options,
             const std::vector<double>& windows_s, const std::optional<Baseline>& baseline)
    : options_(options),
      watched_(watched_parameters(table, options)),
      windows_s_(windows_s),
      threshold_(threshold_for(options, windows_s, watched_)),
      learner_(watched_, options.learn_s, options.amplitude),
      baseline_(baseline.value_or(Baseline(watched_.size()))),
      temperature_(options.quiet_window_s > 0 ? options.quiet_window_s / kBinsPerWindow : kBin_s),
      curves_(watched_.size()),
      recent_(watched_.size()),
      usual_(watched_.size()),
      quiet_learner_(table.size(), quiet_options(options)),
      quiet_baseline_(watched_.size()),
      dependence_(watched_.size()),
      corrected_(watched_.size()),
      explained_(watched_.size()),
      states_(watched_.size()) {
  for (int p = 0; p < table.size(); ++p)
    if (table[p].kind == ParameterKind::bending_stiffness)
      bending_.push_back(static_cast<std::size_t>(p));
  const Baseline none(watched_.size());
  detectors_.assign(windows_s_.size() + 1, ChangeDetector(none, watched_, threshold_));
  news_.reserve(watched_.size());
  begin();
}

void Watch::begin() {
  for (std::size_t i = 0; i < windows_s_.size(); ++i) detectors_[i].set_baseline(baseline_);
  if (!options_.amplitude) return;
  for (std::size_t p = 0; p < curves_.size(); ++p)
    if (baseline_.knows(p) && watched(p))
      curves_[p] = AmplitudeCurve(baseline_.value[p], baseline_.std_error[p] / baseline_.value[p],
                                  baseline_.by_amplitude[p]);
}

void Watch::begin_quiet() {
  std::vector<Watched> watched = watched_;
  for (Watched& w : watched) w.most_bias *= kMostBiasQuiet / kMostBias_k;
  detectors_.back() = ChangeDetector(quiet_baseline_, watched, threshold_);
}

const std::vector<Alarm>& Watch::push(const WindowEstimate& estimate) {
  news_.clear();
  const auto window = static_cast<std::size_t>(estimate.window);
  if (window > windows_s_.size()) return news_;
  const bool quiet = window == windows_s_.size();
  explained_.assign(watched_.size(), {});
  const WindowEstimate& judged = quiet ? corrected_quiet(estimate) : corrected(estimate);
  detectors_[window].push(judged);
  for (std::size_t p = 0; p < states_.size(); ++p) measure(p, judged);
  quiet ? learn_quiet(estimate) : learn(estimate);
  for (int p = 0; p < static_cast<int>(states_.size()); ++p) report(p, estimate);
  return news_;
}

/// Stiffnesses that were identified with another bending cannot be compared later.
bool Watch::bending_known(const WindowEstimate& e) const {
  return std::all_of(bending_.begin(), bending_.end(), [&](std::size_t p) {
    return e.std_error[p] <= kMostBendingError * e.value[p];
  });
}

void Watch::learn(const WindowEstimate& e) {
  const double degc = temperature_.mean(e.start, e.end);
  if (options_.temperature && std::isnan(degc)) return;  // it could not be corrected later
  if (!bending_known(e)) return;
  if (!learner_.push(e, degc)) return;
  const Baseline learned = learner_.baseline();
  for (std::size_t p = 0; p < watched_.size(); ++p) {
    if (baseline_.knows(p) || !learned.knows(p)) continue;
    baseline_.value[p] = learned.value[p];
    baseline_.std_error[p] = learned.std_error[p];
    baseline_.degc[p] = learned.degc[p];
    baseline_.by_amplitude[p] = learned.by_amplitude[p];
  }
  begin();
}

void Watch::learn_quiet(const WindowEstimate& e) {
  if (quiet_known_ || !quiet_learner_.push(e, temperature_.mean(e.start, e.end))) return;
  quiet_known_ = true;
  quiet_baseline_ = quiet_learner_.baseline();
  dependence_ = quiet_learner_.dependence();
  begin_quiet();
}

void Watch::forget_quiet() {
  quiet_known_ = false;
  quiet_learner_ = DependenceLearner(static_cast<int>(watched_.size()), quiet_options(options_));
  quiet_baseline_ = Baseline(watched_.size());
  begin_quiet();
}

double Watch::quiet_learned() const {
  return quiet_known_ ? 1 : quiet_learner_.learned_s() / (kSeconds * options_.quiet_learn_hours);
}

/// For an ordinary window: the expected effect of its temperature on the baseline's value.
Dependence::Expected Watch::expected(std::size_t p, double degc) const {
  const double from = baseline_.degc[p];
  const bool known = quiet_known_ && quiet_baseline_.knows(p);
  if (!std::isnan(degc) && known) return dependence_.change(p, from, degc);
  const double off = std::isnan(degc) ? kUnknown_degc : std::abs(degc - from);
  const double per_degc = known ? dependence_.usual_per_degc(p) : DependenceLearner::kUsualPerDegc;
  return {1, per_degc * off};
}

/// The value as it would be under the conditions of the baseline, which make intact.ratio of it, or
/// anything between low and high: what the conditions may explain is no deviation, because it is
/// the same in every window. What is found nevertheless is measured without that.
Watch::Explained Watch::correct(WindowEstimate& e, std::size_t p, double baseline,
                                const Intact& intact) const {
  const double below = 1 - intact.low / intact.ratio, above = intact.high / intact.ratio - 1;
  if (!std::isfinite(below) || !std::isfinite(above) || !(intact.ratio > 0)) {
    e.reason[p] = Observability::quiet;
    return {};
  }
  const double off = e.value[p] / intact.ratio / baseline - 1;
  const double left = off > 0 ? std::max(off - above, 0.0) : std::min(off + below, 0.0);
  e.value[p] = baseline * (1 + left);
  e.std_error[p] /= intact.ratio;
  return {off - left, (off > 0 ? above : below) / kExpectedErrors};
}

bool Watch::is_shorter(const WindowEstimate& e) const {
  return windows_s_[static_cast<std::size_t>(e.window)] < windows_s_[0];
}

Watch::Intact Watch::intact(std::size_t p, const WindowEstimate& e, double degc) const {
  Dependence::Expected warm{1, 0};
  if (options_.temperature && !std::isnan(baseline_.degc[p])) warm = expected(p, degc);
  Intact out{1, 0, 0};
  out.low = 1 - kExpectedErrors * warm.std_error, out.high = 1 + kExpectedErrors * warm.std_error;
  if (curves_[p].known()) {
    // The curve is of what the element has gone through of late; it may have recovered by now.
    // The baseline is of main windows; within one shorter windows are now weaker, now stronger.
    const double own = e.amplitude[p];
    const double now = is_shorter(e) ? std::max(own, recent_[p].newest()) : own;
    if (!(now > 0)) return {1, -kInfinity, kInfinity};
    const AmplitudeCurve& curve = curves_[p];
    const double before = std::max(recent_[p].at(seconds_of(e.end)), now);
    out.low +=
        std::min(curve.least(now, kExpectedErrors), curve.least(before, kExpectedErrors)) - 1;
    out.high += std::max(curve.most(now, kExpectedErrors), curve.most(before, kExpectedErrors)) - 1;
    out.ratio = std::clamp(curve.expected(before).ratio, out.low, out.high);
  }
  for (double* ratio : {&out.ratio, &out.low, &out.high}) *ratio *= warm.ratio;
  return out;
}

void Watch::remember_amplitudes(const WindowEstimate& e) {
  for (std::size_t p = 0; p < watched_.size(); ++p) {
    if (!watched(p) || !(e.amplitude[p] > 0)) continue;
    recent_[p].push(seconds_of(e.end), e.amplitude[p]);
    if (quiet_known_ || options_.quiet_window_s <= 0) continue;
    usual_[p].sum += std::log(e.amplitude[p]);
    ++usual_[p].count;
  }
}

/// By how much a quiet value may still be too low after strong motion, relative.
double Watch::recovering(std::size_t p, Time now) const {
  const double recent = recent_[p].at(seconds_of(now));
  if (!options_.amplitude || usual_[p].count == 0 || !(recent > 0)) return 0;
  const double usual = usual_[p].sum / static_cast<double>(usual_[p].count);
  return kExpectedErrors * AmplitudeCurve::kUsualPerLog *
         std::max(std::log(recent / kStrong) - usual, 0.0);
}

const WindowEstimate& Watch::corrected(const WindowEstimate& e) {
  if ((!options_.temperature && !options_.amplitude) || !used(e)) return e;
  const double degc = temperature_.mean(e.start, e.end);
  corrected_ = e;
  if (e.window == 0) remember_amplitudes(e);
  for (std::size_t p = 0; p < watched_.size(); ++p) {
    if (!baseline_.knows(p) || !watched(p) || e.reason[p] != Observability::observable) continue;
    explained_[p] = correct(corrected_, p, baseline_.value[p], intact(p, e, degc));
  }
  return corrected_;
}

const WindowEstimate& Watch::corrected_quiet(const WindowEstimate& e) {
  corrected_ = e;
  const double degc = temperature_.mean(e.start, e.end);
  for (std::size_t p = 0; p < watched_.size(); ++p) {
    if (!quiet_baseline_.knows(p) || e.reason[p] != Observability::observable) continue;
    const Dependence::Expected now =
        dependence_.expected(p, {degc, DependenceLearner::log_amplitude(e, p)});
    const double explained = kExpectedErrors * now.std_error;
    explained_[p] = correct(corrected_, p, quiet_baseline_.value[p],
                            {now.ratio, now.ratio * (1 - explained - recovering(p, e.end)),
                             now.ratio * (1 + explained)});
  }
  return corrected_;
}

std::size_t Watch::sizing_window(std::size_t detector) const {
  return detector == windows_s_.size() ? detector : 0;
}

bool Watch::measures(std::size_t p, const WindowEstimate& e) const {
  const State& state = states_[p];
  return state.id != 0 && static_cast<std::size_t>(e.window) == sizing_window(state.detector) &&
         e.start >= state.sized_until;
}

bool Watch::used(const WindowEstimate& e) const {
  if (detectors_[static_cast<std::size_t>(e.window)].takes(e)) return true;
  for (std::size_t p = 0; p < states_.size(); ++p)
    if (measures(p, e)) return true;
  return false;
}

void Watch::measure(std::size_t p, const WindowEstimate& e) {
  if (!measures(p, e) || !watched_[p].counts(e, p)) return;
  State& state = states_[p];
  const auto window = static_cast<std::size_t>(e.window);
  state.sized_until = e.end;
  const double baseline =
      window == windows_s_.size() ? quiet_baseline_.value[p] : baseline_.value[p];
  const double error = e.std_error[p] / baseline;
  state.size.push(e.value[p] / baseline - 1 + explained_[p].off,
                  std::max(error, detectors_[window].usual_error(static_cast<int>(p))),
                  explained_[p].std_error);
}

Change Watch::found_by(std::size_t detector, int parameter) const {
  Change out = detectors_[detector].change(parameter);
  const Explained& explained = explained_[static_cast<std::size_t>(parameter)];
  out.ratio += explained.off;
  out.std_error = std::hypot(out.std_error, explained.std_error);
  return out;
}

/// From the first windows that saw it until one lies wholly behind it.
Change Watch::size_of(int parameter) const {
  const auto p = static_cast<std::size_t>(parameter);
  const State& state = states_[p];
  if (!state.size.known()) return found_by(state.detector, parameter);
  const Baseline& b = state.detector == windows_s_.size() ? quiet_baseline_ : baseline_;
  return {state.size.ratio(), std::hypot(state.size.std_error(), b.std_error[p] / b.value[p]),
          state.reported.since};
}

void Watch::report(int parameter, const WindowEstimate& estimate) {
  State& state = states_[static_cast<std::size_t>(parameter)];
  const auto window = static_cast<std::size_t>(estimate.window);
  const bool changed = detectors_[window].changed(parameter);
  if (state.id == 0) {
    if (!changed) return;
    const Change found = found_by(window, parameter);
    // The change lies within the first window that shows it.
    state = {++last_id_, window, found, {}, found.since + (estimate.end - estimate.start)};
    news_.push_back({state.id, AlarmState::raised, parameter, state.reported, estimate.end});
    return;
  }
  if (state.detector == window && !changed) {
    news_.push_back({state.id, AlarmState::cleared, parameter, state.reported, estimate.end});
    state = {};
    return;
  }
  if (window != (state.size.known() ? sizing_window(state.detector) : state.detector)) return;
  const Change now = size_of(parameter);
  const double moved = std::abs(now.ratio - state.reported.ratio);
  if (moved < kNewsErrors * state.reported.std_error &&
      now.std_error > kSharper * state.reported.std_error)
    return;
  state.reported = now;
  news_.push_back({state.id, AlarmState::changed, parameter, now, estimate.end});
}

}  // namespace framewatch::estimator
