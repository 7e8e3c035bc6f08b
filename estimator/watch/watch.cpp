#include "estimator/watch/watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

/// A frame's stiffness that is known to less says nothing of a change that matters, and how well it
/// is known is itself known badly.
constexpr double kMaxErrorRatio = 0.035;
/// Windows shorter than this share of their length, after a start, have errors from few blocks.
constexpr double kWhole = 0.98;

/// Of a story's least relevant change: what a group of several in series shows of a larger one.
constexpr double kOfGroup = 0.5;
constexpr double kSeconds = 3600, kHoursPerYear = 8766;
constexpr double kBinsPerWindow = 20, kBin_s = 60;  // of the temperature's means
constexpr double kMaxBendingError = 0.1;            // relative, of windows to learn from

/// A design off by its tolerance may not bias a value by more than this share of the least relevant
/// change. For a panel that is one or two standard errors of its values, so that a bias common to
/// all windows must be allowed for; for a frame it is many.
constexpr double kMaxBias_k = 0.1, kMaxBias_g = 0.25;
/// The same in long windows, whose baseline has the same bias.
constexpr double kMaxBiasQuiet = 0.4;

DependenceOptions quiet_options(const WatchOptions& o) {
  return {kSeconds * o.quiet_learn_hours, o.temperature, o.amplitude};
}

/// From the number of tests per year over the accepted false alarms: docs/equations.md (41).
double threshold_for(const WatchOptions& o, const std::vector<double>& windows_s,
                     const std::vector<Watched>& watched) {
  // What everything has in common is one more.
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
  const double length_s = std::chrono::duration<double>(given.end - given.start).count();
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

/// Stiffnesses that were identified with another bending cannot be compared later.
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

}  // namespace framewatch::estimator
