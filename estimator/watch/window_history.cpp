// SPDX-License-Identifier: MIT
#include "estimator/watch/window_history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/watch/change_detector.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {
namespace {

/// Difference of twice the log-likelihood that bounds the 95 % interval.
constexpr double kInterval = 4;
constexpr double kTimeFreedom =
    10;  // of Student's distribution, so that an outlier costs little more
/// A window half behind the change shows half of it, within this share: motion is not uniform.
constexpr double kShareError = 0.2;
constexpr double kLengthsInCommon = 2;  // windows of different length share their motion
constexpr std::size_t kMaxInstants = 100;

/// Least squares of y = from + share * step, with a prior of 0 for `from`.
struct Fit {
  double from = 0, step = 0;
  bool known = false;
};

class Division {
 public:
  Division(std::span<const WindowHistory* const> histories, std::size_t parameter,
           double before_error)
      : histories_(histories), p_(parameter), before_(1 / (before_error * before_error)) {}

  /// Returns the misfit of a change at `at`; infinite when no window shows one.
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

WindowHistory::WindowHistory(std::size_t parameters)
    : parameters_(parameters),
      start_(kMax),
      end_(kMax),
      off_(kMax * parameters, 0.0F),
      std_error_(kMax * parameters, 0.0F),
      common_error_(kMax * parameters, 0.0F) {}

/// Moves the windows from `from` on by one place to `to`.
void WindowHistory::move(std::size_t from, std::size_t to) {
  const auto shift = [&](auto& values, std::size_t width) {
    const auto at = [&](std::size_t i) {
      return values.begin() + static_cast<std::ptrdiff_t>(i * width);
    };
    if (from > to)
      std::copy(at(from), at(count_), at(to));
    else
      std::copy_backward(at(from), at(count_), at(count_ + 1));
  };
  shift(start_, 1);
  shift(end_, 1);
  for (std::vector<float>* of : {&off_, &std_error_, &common_error_}) shift(*of, parameters_);
}

std::size_t WindowHistory::add(Time start, Time end) {
  if (count_ == kMax) {
    if (end < end_[0]) return kMax;
    move(1, 0);
    --count_;
  }
  const auto last = end_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto at =
      static_cast<std::size_t>(std::upper_bound(end_.begin(), last, end) - end_.begin());
  if (at < count_) move(at, at + 1);
  ++count_;
  start_[at] = start;
  end_[at] = end;
  const auto from = static_cast<std::ptrdiff_t>(at * parameters_);
  const auto width = static_cast<std::ptrdiff_t>(parameters_);
  for (std::vector<float>* of : {&off_, &std_error_, &common_error_})
    std::fill(of->begin() + from, of->begin() + from + width, 0.0F);
  return at;
}

void WindowHistory::put(std::size_t place, std::size_t parameter, const Value& value) {
  const std::size_t i = place * parameters_ + parameter;
  off_[i] = static_cast<float>(value.off);
  std_error_[i] = static_cast<float>(value.std_error);
  common_error_[i] = static_cast<float>(value.common_error);
}

std::size_t WindowHistory::first(std::size_t parameter, Time from) const {
  std::size_t place = 0;
  while (place < count_ && (start_[place] < from || !has(place, parameter))) ++place;
  return place;
}

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
