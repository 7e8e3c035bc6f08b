// SPDX-License-Identifier: MIT
#include "estimator/watch/watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

/// A frame stiffness with a larger relative error shows no relevant change, and its error is itself
/// uncertain.
constexpr double kMaxErrorRatio = 0.035;
/// Windows shorter than this share of their length, after a start, take errors from few blocks.
constexpr double kWhole = 0.98;

/// A group of stories in series shows this share of a story's least relevant change.
constexpr double kOfGroup = 0.5;
constexpr double kSeconds = 3600, kHoursPerYear = 8766;
constexpr double kBinsPerWindow = 20, kBin_s = 60;  // for the mean temperature
constexpr double kMaxBendingError = 0.1;            // relative, of windows to learn from

/// A design off by its tolerance may bias a value by at most this share of the least relevant
/// change. For a panel that is one or two standard errors, so a common bias must be tolerated; for
/// a frame it is many.
constexpr double kMaxBias_k = 0.1, kMaxBias_g = 0.25;
/// The share in long windows, whose baseline has the same bias.
constexpr double kMaxBiasQuiet = 0.4;

DependenceOptions quiet_options(const WatchOptions& o) {
  return {kSeconds * o.quiet_learn_hours, o.temperature, o.amplitude};
}

/// Computes the threshold from the number of tests per year over the accepted false alarms:
/// docs/equations.md (41).
double threshold_for(const WatchOptions& o, const std::vector<double>& windows_s,
                     const std::vector<Watched>& watched) {
  // The common change is one more parameter.
  const auto count =
      1 + static_cast<double>(std::count_if(watched.begin(), watched.end(),
                                            [](const Watched& w) { return w.least_change > 0; }));
  const double tests_per_window = 2 * count * ChangeDetector::kPhases * ChangeDetector::kSizes;
  double tests = 0;
  for (const double s : windows_s)
    tests += tests_per_window * kSeconds * o.shaking_hours_per_year / s;
  if (o.quiet_window_s > 0) tests += tests_per_window * kSeconds * kHoursPerYear / o.quiet_window_s;
  const double wald = std::log(std::max(tests / o.alarms_per_year, 2.0));
  return std::max(wald - ChangeDetector::kOvershoot, std::log(2.0));
}

constexpr double kExpectedErrors = 3;
/// For long windows, recent motion counts from so many times the usual amplitude on.
constexpr double kStrong = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnknown_degc = 10;  // assumed deviation while the thermometer is silent
/// An element shaken more than this many times the strongest motion learned may still recover.
constexpr double kBeyondLearned = 1.5;

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
      out[p] = watched((group ? kOfGroup : 1) * o.least_change_k, kMaxBias_k, kind, 0);
    if (kind == ParameterKind::panel_stiffness)
      out[p] = watched(o.least_change_g, kMaxBias_g, kind, kMaxBias_g);
  }
  return out;
}

Watch::Watch(const ParameterTable& table, const WatchOptions& options,
             const std::vector<double>& windows_s, const std::optional<Baseline>& baseline,
             const ChangeModel& model)
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
      book_(table, watched_, windows_s_, options.quiet_window_s, threshold_, model),
      corrected_(watched_.size()),
      explained_(watched_.size()),
      doubted_(watched_.size()) {
  certain_ = WindowEstimate(watched_.size());
  for (int p = 0; p < table.size(); ++p) {
    const bool frame = table[p].kind == ParameterKind::frame_stiffness;
    stiffness_of_frames_.push_back(frame ? 1 : 0);
  }
  for (int p = 0; p < table.size(); ++p)
    if (table[p].kind == ParameterKind::bending_stiffness)
      bending_.push_back(static_cast<std::size_t>(p));
  begin();
}

void Watch::begin() {
  book_.set_baseline(baseline_);
  if (!options_.amplitude) return;
  for (std::size_t p = 0; p < curves_.size(); ++p)
    if (baseline_.knows(p) && watched(p))
      curves_[p] = AmplitudeCurve(baseline_.value[p], baseline_.std_error[p] / baseline_.value[p],
                                  baseline_.by_amplitude[p]);
}

void Watch::begin_quiet() {
  std::vector<Watched> watched = watched_;
  for (Watched& w : watched) w.most_bias *= kMaxBiasQuiet / kMaxBias_k;
  book_.begin_long(quiet_baseline_, watched);
}

const WindowEstimate& Watch::certain(const WindowEstimate& e) {
  bool all = true;
  for (std::size_t p = 0; p < watched_.size(); ++p)
    all = all && !(e.std_error[p] > kMaxErrorRatio * e.value[p] && stiffness_of_frames_[p] != 0);
  if (all) return e;
  certain_ = e;
  for (std::size_t p = 0; p < watched_.size(); ++p) {
    if (stiffness_of_frames_[p] == 0 || !(e.std_error[p] > kMaxErrorRatio * e.value[p])) continue;
    certain_.reason[p] = Observability::quiet;
    certain_.value[p] = certain_.std_error[p] = kNaN;
  }
  return certain_;
}

const std::vector<Alarm>& Watch::push(const WindowEstimate& given) {
  const auto window = static_cast<std::size_t>(given.window);
  if (window > windows_s_.size() || given.late) return none_;
  const bool quiet = window == windows_s_.size();
  const double length_s = seconds_of(given.end - given.start);
  if (!quiet && length_s < kWhole * windows_s_[window]) return none_;
  const WindowEstimate& estimate = quiet ? given : certain(given);
  const std::vector<Alarm>* news = &none_;
  if (book_.takes(estimate)) {
    explained_.assign(watched_.size(), {});
    const WindowEstimate& judged = quiet ? corrected_quiet(estimate) : corrected(estimate);
    find_doubted(estimate);
    news = &book_.push(judged, explained_, doubted_);
  }
  quiet ? learn_quiet(estimate) : learn(estimate);
  return *news;
}

/// Stiffnesses identified with an inexact bending stiffness cannot be compared later.
bool Watch::bending_known(const WindowEstimate& e) const {
  return std::all_of(bending_.begin(), bending_.end(), [&](std::size_t p) {
    return e.std_error[p] <= kMaxBendingError * e.value[p];
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

/// Returns the expected effect of an ordinary window's temperature on the baseline's value.
Dependence::Expected Watch::expected(std::size_t p, double degc) const {
  const double from = baseline_.degc[p];
  const bool known = quiet_known_ && quiet_baseline_.knows(p);
  if (!std::isnan(degc) && known) return dependence_.change(p, from, degc);
  const double off = std::isnan(degc) ? kUnknown_degc : std::abs(degc - from);
  const double per_degc = known ? dependence_.usual_per_degc(p) : DependenceLearner::kUsualPerDegc;
  return {1, per_degc * off};
}

/// Corrects the value to the conditions of the baseline. They scale an intact element by
/// intact.ratio, or by anything between low and high: a deviation within that range does not count,
/// because every window shares it. A larger deviation is measured from the edge of the range.
Explained Watch::correct(WindowEstimate& e, std::size_t p, double baseline,
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
    // The curve depends on recent amplitudes, from which the element may have recovered by now. The
    // baseline comes from main windows, within which shorter windows vary in strength.
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

/// Returns how much a quiet value may still be too low after strong motion, relative.
double Watch::recovering(std::size_t p, Time now) const {
  const double recent = recent_[p].at(seconds_of(now));
  if (!options_.amplitude || usual_[p].count == 0 || !(recent > 0)) return 0;
  const double usual = usual_[p].sum / static_cast<double>(usual_[p].count);
  return kExpectedErrors * AmplitudeCurve::kUsualPerLog *
         std::max(std::log(recent / kStrong) - usual, 0.0);
}

const WindowEstimate& Watch::corrected(const WindowEstimate& e) {
  if (!options_.temperature && !options_.amplitude) return e;
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

/// Marks gains as doubtful after motion beyond the amplitudes learned: the element recovers, or the
/// curve is extrapolated.
void Watch::find_doubted(const WindowEstimate& e) {
  for (std::size_t p = 0; p < watched_.size(); ++p)
    doubted_[p] = curves_[p].known() &&
                          recent_[p].at(seconds_of(e.end)) > kBeyondLearned * curves_[p].highest_m()
                      ? 1
                      : 0;
}

}  // namespace framewatch::estimator
