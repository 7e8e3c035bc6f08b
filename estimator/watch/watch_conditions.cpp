// What the conditions, temperature and amplitude, make of an intact element's values.
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/watch/watch.h"

namespace framewatch::estimator {
namespace {

constexpr double kExpectedErrors = 3;
/// Motion of late counts, for long windows, from so many times the usual amplitude on.
constexpr double kStrong = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnknown_degc = 10;  // assumed deviation while the thermometer is silent
/// An element that was shaken so many times as strongly as ever learned may still recover.
constexpr double kBeyondLearned = 1.5;

}  // namespace

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

/// After motion beyond what was learned a gain is doubted: the element recovers, or the curve is
/// continued beyond its end.
void Watch::find_doubted(const WindowEstimate& e) {
  for (std::size_t p = 0; p < watched_.size(); ++p)
    doubted_[p] = curves_[p].known() &&
                          recent_[p].at(seconds_of(e.end)) > kBeyondLearned * curves_[p].highest_m()
                      ? 1
                      : 0;
}

}  // namespace framewatch::estimator
