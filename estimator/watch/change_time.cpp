#include "estimator/watch/change_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "estimator/watch/change_detector.h"
#include "estimator/watch/separate_windows.h"

namespace framewatch::estimator {
namespace {

/// Twice the logarithm of a likelihood ratio: 95 % of the most likely instants lie within.
constexpr double kInterval = 4;
constexpr double kTimeFreedom = 10;  // of Student's distribution: a wild window costs little more
/// A window half behind the change has half of it, give or take this share: its motion is not the
/// same all the time.
constexpr double kShareError = 0.2;
constexpr double kLengthsInCommon = 2;  // windows of different length have their motion in common
constexpr std::size_t kMaxInstants = 100;

/// Least squares of y = from + share * step, `from` drawn to 0.
struct Fit {
  double from = 0, step = 0;
  bool known = false;
};

class Division {
 public:
  Division(std::span<const WindowHistory* const> histories, std::size_t parameter,
           double before_error)
      : histories_(histories), p_(parameter), before_(1 / (before_error * before_error)) {}

  /// What the windows object to a change at `at`; infinite where none of them shows one.
  double objection(Time at) const {
    Fit fit = fitted(at, 0);
    fit = fitted(at, fit.step);
    if (!fit.known) return std::numeric_limits<double>::infinity();
    double cost = 0;
    each(at, [&](const WindowHistory::Value& v, double share) {
      const double variance = v.std_error * v.std_error, all = variance + extra(share, fit.step);
      const double off = v.off - fit.from - share * fit.step;
      cost += (kTimeFreedom + 1) * std::log1p(off * off / all / kTimeFreedom) +
              std::log(all / variance);
    });
    return cost / (ChangeDetector::kPhases * kLengthsInCommon) + fit.from * fit.from * before_;
  }

 private:
  template <typename Take>
  void each(Time at, const Take& take) const {
    for (const WindowHistory* h : histories_)
      for (std::size_t i = 0; i < h->size(); ++i)
        if (h->has(i, p_))
          take(h->value(i, p_),
               std::clamp(seconds_of(h->end(i) - at) / seconds_of(h->end(i) - h->start(i)), 0.0,
                          1.0));
  }
  static double extra(double share, double step) {
    const double error = 4 * kShareError * share * (1 - share) * step;
    return error * error;
  }
  Fit fitted(Time at, double step) const {
    double w = before_ * ChangeDetector::kPhases * kLengthsInCommon, s = 0, ss = 0, y = 0, sy = 0;
    each(at, [&](const WindowHistory::Value& v, double share) {
      const double weight = 1 / (v.std_error * v.std_error + extra(share, step));
      w += weight, s += weight * share, ss += weight * share * share;
      y += weight * v.off, sy += weight * share * v.off;
    });
    const double across = ss - s * s / w;
    if (!(across > 0)) return {};
    const double slope = (sy - s * y / w) / across;
    return {(y - s * slope) / w, slope, std::isfinite(slope)};
  }

  std::span<const WindowHistory* const> histories_;
  std::size_t p_;
  double before_;
};

}  // namespace

std::optional<ChangeTime> time_of_change(std::span<const WindowHistory* const> histories,
                                         std::size_t parameter, double before_error, Time from,
                                         Time to, SensorClock::duration step) {
  const auto least =
      SensorClock::duration((to - from).count() / static_cast<SensorClock::rep>(kMaxInstants - 1));
  step = std::max({step, least, SensorClock::duration(1)});
  const Division division(histories, parameter, before_error);
  std::array<double, kMaxInstants + 1> cost{};
  std::size_t count = 0, best = 0;
  for (Time at = from; at <= to && count < cost.size(); at += step, ++count) {
    cost[count] = division.objection(at);
    if (cost[count] < cost[best]) best = count;
  }
  if (count == 0 || !std::isfinite(cost[best])) return std::nullopt;
  const auto instant = [&](std::size_t i) {
    return from + static_cast<SensorClock::rep>(i) * step;
  };
  ChangeTime out{instant(best), instant(best), instant(best)};
  for (std::size_t i = 0; i < count; ++i) {
    if (cost[i] > cost[best] + kInterval) continue;
    out.earliest = std::min(out.earliest, instant(i));
    out.latest = std::max(out.latest, instant(i));
  }
  out.latest += step;
  return out;
}

}  // namespace framewatch::estimator
