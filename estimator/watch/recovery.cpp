// SPDX-License-Identifier: MIT
#include "estimator/watch/recovery.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

/// Unknowns of the fit: level at the reference time, slope, and the common errors of the amplitude
/// curve and of the two baselines.
constexpr int kOfLevel = 0, kOfSlope = 1, kOfCurve = 2, kOfBaseline = 3, kLawUnknowns = 5;
/// Prior of the slope per decade of time: softened concrete and rock recover by some percent of
/// their stiffness per decade, rarely by more than 5 %.
constexpr double kUsualSlope = 0.05;
/// No loss is larger than the whole stiffness.
constexpr double kUsualLevel = 1;
/// The slope may change by this share of itself per decade beyond the newest window: a material has
/// a longest relaxation time, beyond which recovery stops (Snieder et al. 2017, eq. 8).
constexpr double kBendPerDecade = 0.3;
/// Largest misfit of a law beyond the one expected by chance, in its standard deviations.
constexpr double kMisfit = 3;
/// Fewest points of a part of the record that is fitted alone.
constexpr std::size_t kMinPoints = 4;

/// Returns the mean of log10(t) from `from_s` >= 0 to `to_s` > from_s.
double mean_log(double from_s, double to_s) {
  const auto part = [](double t) { return t > 0 ? t * std::log(t) : 0; };
  const double mean = (part(to_s) - part(from_s)) / (to_s - from_s) - 1;
  return std::max(mean / std::numbers::ln10, 0.0);
}

}  // namespace

RecoveryWindow recovery_window(Time start, Time end, double value, double std_error,
                               double amplitude_m, double baseline, double baseline_error,
                               const AmplitudeCurve& curve, double usual_amplitude_m) {
  const double own = baseline_error / baseline;
  double ratio = 1, error = 0, side = 0;
  if (curve.known()) {
    const AmplitudeCurve::Expected expected = curve.expected(amplitude_m);
    ratio = expected.ratio;
    error = std::sqrt(std::max(expected.std_error * expected.std_error - own * own, 0.0));
    side = std::log(amplitude_m) - 0.5 * std::log(curve.lowest_m() * curve.highest_m());
  } else {
    side = std::log(amplitude_m / usual_amplitude_m);
    error = AmplitudeCurve::kUsualPerLog * std::abs(side);
  }
  const double intact = baseline * ratio;
  return {start, end, value / intact - 1, std_error / intact, own, std::copysign(error, side), 0};
}

/// The law and the covariance of its unknowns.
struct Recovery::Fit {
  Eigen::Matrix<double, kLawUnknowns, 1> x = Eigen::Matrix<double, kLawUnknowns, 1>::Zero();
  Eigen::Matrix<double, kLawUnknowns, kLawUnknowns> covariance;
  Eigen::Matrix<double, kLawUnknowns, 1>
      noise_only;        ///< variances if baseline and curve were exact
  double reference = 0;  ///< log10 of the time of `level`
  double first = 0, last = 0;
  double misfit = 0;  ///< of the means about the law, weighted
  int freedom = 0, windows = 0;

  /// Returns the standard error of the loss at a logarithm of time; beyond `last` it includes the
  /// bend of the law.
  double loss(double log) const { return -(x[kOfLevel] + x[kOfSlope] * (log - reference)); }
  double error(double log) const {
    const double d = log - reference, beyond = std::max(log - last, 0.0);
    const double variance = covariance(kOfLevel, kOfLevel) +
                            2 * d * covariance(kOfLevel, kOfSlope) +
                            d * d * covariance(kOfSlope, kOfSlope);
    return std::hypot(std::sqrt(std::max(variance, 0.0)),
                      kBendPerDecade * std::abs(x[kOfSlope]) * beyond * beyond / 2);
  }
  double slope_error() const { return std::sqrt(covariance(kOfSlope, kOfSlope)); }
};

void Recovery::begin(Time end_of_motion) {
  active_ = true;
  began_ = end_of_motion;
  last_end_.fill(end_of_motion);
  bins_.fill({});
  renewed_ = 0;
  newest_s_ = 0;
}

void Recovery::push(const RecoveryWindow& w) {
  if (!active_ || w.source >= kSources || !(w.std_error > 0) || !std::isfinite(w.off)) return;
  if (w.start < last_end_[w.source]) return;
  last_end_[w.source] = w.end;
  newest_s_ = std::max(newest_s_, seconds_of(w.end - began_));
  const double log = mean_log(seconds_of(w.start - began_), seconds_of(w.end - began_));
  const auto place = std::clamp(kBinsPerDecade * log, 0.0, static_cast<double>(kBins) - 0.5);
  Bin& bin = bins_[w.source * kBins + static_cast<std::size_t>(place)];
  const double weight = 1 / (w.std_error * w.std_error);
  ++bin.count;
  bin.weight += weight;
  bin.log += weight * log;
  bin.off += weight * w.off;
  bin.amplitude += weight * w.amplitude_error;
  bin.baseline += weight * w.baseline_error;
  bin.log_square += weight * log * log;
  bin.log_off += weight * log * w.off;
  bin.off_square += weight * w.off * w.off;
}

bool Recovery::is_of(Time since) const {
  const double after_s = seconds_of(since - began_);
  return active_ && after_s >= -kMotion_s && after_s <= kRenew_s[0];
}

int Recovery::windows() const {
  int out = 0;
  for (const Bin& b : bins_) out += b.count;
  return out;
}

/// Returns the points in order of time.
std::vector<Recovery::Point> Recovery::points() const {
  std::vector<Point> out;
  for (std::size_t i = 0; i < kBins; ++i)
    for (std::size_t source = 0; source < kSources; ++source) {
      const Bin& b = bins_[source * kBins + i];
      if (b.count == 0) continue;
      out.push_back({source, b.count, b.weight, b.log / b.weight, b.off / b.weight,
                     b.amplitude / b.weight, b.baseline / b.weight,
                     b.log_square - b.log * b.log / b.weight, b.log_off - b.log * b.off / b.weight,
                     b.off_square - b.off * b.off / b.weight});
    }
  return out;
}

/// excess: variance of the windows over what their errors predict.
Recovery::Fit Recovery::fit(const std::vector<Point>& points, std::size_t from, double excess) {
  Fit out;
  out.first = points[from].log;
  double weight = 0;
  for (std::size_t i = from; i < points.size(); ++i) {
    weight += points[i].weight;
    out.reference += points[i].weight * points[i].log;
    out.last = std::max(out.last, points[i].log);
    out.windows += points[i].count;
  }
  out.reference /= weight;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kLawUnknowns, kLawUnknowns);
  information.diagonal() << 1 / (kUsualLevel * kUsualLevel), 1 / (kUsualSlope * kUsualSlope), 1, 1,
      1;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kLawUnknowns);
  const auto row_of = [&](const Point& p) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(kLawUnknowns);
    row[kOfLevel] = 1;
    row[kOfSlope] = p.log - out.reference;
    row[kOfCurve] = p.amplitude;
    row[kOfBaseline + static_cast<int>(p.source)] = p.baseline;
    return row;
  };
  for (std::size_t i = from; i < points.size(); ++i) {
    const Eigen::VectorXd row = row_of(points[i]);
    const double w = points[i].weight / excess;
    information += w * row * row.transpose();
    right += w * points[i].off * row;
  }
  const Eigen::MatrixXd covariance = inverse(information);
  out.covariance = covariance;
  out.x = covariance * right;
  Eigen::MatrixXd exact = information.topLeftCorner(2, 2);
  out.noise_only.setZero();
  out.noise_only.head(2) = inverse(exact).diagonal();
  for (std::size_t i = from; i < points.size(); ++i) {
    const double off = points[i].off - row_of(points[i]).dot(out.x);
    out.misfit += points[i].weight / excess * off * off;
  }
  out.freedom = static_cast<int>(points.size() - from) - 2;
  return out;
}

/// Returns the variance of the windows about the law within their bins, over what their errors
/// predict.
double Recovery::excess(const std::vector<Point>& points, const Fit& fit) {
  const double slope = fit.x[kOfSlope];
  double square = 0;
  int freedom = -1;
  for (const Point& p : points) {
    square += p.off_off - 2 * slope * p.log_off + slope * slope * p.log_log;
    freedom += p.count - 1;
  }
  return freedom > 0 ? std::max(square / freedom, 1.0) : 1;
}

/// Fits the longest newest part that one law describes.
Recovery::Fit Recovery::fit_newest(const std::vector<Point>& points) {
  Fit whole = fit(points, 0, 1);
  const double excess = Recovery::excess(points, whole);
  whole = fit(points, 0, excess);
  Fit best = whole;
  for (std::size_t from = 0; from + kMinPoints <= points.size(); ++from) {
    if (points.back().log - points[from].log < kMinSpan) break;
    best = from == 0 ? whole : fit(points, from, excess);
    if (best.freedom <= 0) break;
    const double expected = best.freedom, scatter = std::sqrt(2 * expected);
    if (best.misfit <= expected + kMisfit * scatter) return best;
  }
  // No part fits well: the means scatter more than windows within a bin do.
  if (best.freedom > 0 && best.misfit > best.freedom) {
    const double more = best.misfit / best.freedom;
    const auto from =
        static_cast<std::size_t>(std::find_if(points.begin(), points.end(),
                                              [&](const Point& p) { return p.log >= best.first; }) -
                                 points.begin());
    best = fit(points, from, excess * more);
  }
  return best;
}

Recovery::Loss Recovery::loss_at(double time_s) const {
  constexpr double kNear = 0.301;  // a factor 2
  const double log = std::log10(std::max(time_s, kFirst_s));
  double weight = 0, off = 0, common = 0;
  Loss out;
  const std::vector<Point> all = points();
  if (all.empty()) return out;
  const double excess = Recovery::excess(all, fit(all, 0, 1));
  for (const Point& p : all) {
    if (std::abs(p.log - log) > kNear) continue;
    weight += p.weight;
    off += p.weight * p.off;
    common += p.weight * std::hypot(p.amplitude, p.baseline);
    out.count += p.count;
  }
  if (out.count == 0) return out;
  out.loss = -off / weight;
  out.std_error = std::hypot(std::sqrt(excess / weight), common / weight);
  return out;
}

RecoveryLaw Recovery::law() const {
  RecoveryLaw out;
  out.time_s = newest_s_;
  const std::vector<Point> all = points();
  if (all.empty()) return out;
  const Fit fit = fit_newest(all);
  const double now = std::log10(std::max(newest_s_, kFirst_s));
  out.loss = fit.loss(now);
  out.std_error = fit.error(now);
  out.slope = fit.x[kOfSlope];
  out.slope_error = fit.slope_error();
  out.first_s = std::pow(10, all.front().log);
  const Loss first = loss_at(out.first_s);
  out.first_loss = first.loss;
  out.first_error = first.std_error;
  constexpr double kDay_s = 86400;
  out.later_s = kYear_s;
  for (const double later : {kDay_s, 30 * kDay_s})
    if (newest_s_ < later) {
      out.later_s = later;
      break;
    }
  const double later = std::log10(out.later_s);
  // The slope is that of recovery, so it cannot make a loss grow.
  out.later_loss = std::clamp(fit.loss(later), 0.0, std::max(out.loss, 0.0));
  out.later_error = fit.error(later);
  out.later_low = std::max(out.later_loss - kErrors * out.later_error, 0.0);
  out.later_high = out.later_loss + kErrors * out.later_error;
  judge(fit, out);
  return out;
}

void Recovery::judge(const Fit& fit, RecoveryLaw& law) const {
  const double year = std::max(std::log10(kYear_s), fit.last);
  const double stays = fit.loss(year) - kErrors * fit.error(year);
  const double span = fit.last - fit.first;
  const auto is = [&law](RecoveryVerdict verdict, RecoveryReason reason) {
    law.verdict = verdict;
    law.reason = reason;
  };
  if (fit.windows < static_cast<int>(kFewest))
    return is(RecoveryVerdict::not_known, RecoveryReason::few_windows);
  if (law.loss + kErrors * law.std_error < least_change_)
    return is(RecoveryVerdict::recovered, RecoveryReason::none);
  if (span < kMinSpan) return is(RecoveryVerdict::not_known, RecoveryReason::short_time);
  const double later = std::log10(law.later_s);
  if (stays > 0 && fit.loss(later) > kErrors * fit.error(later)) {
    law.stays = stays;
    return is(RecoveryVerdict::lasting, RecoveryReason::none);
  }
  const bool lost =
      law.loss > kErrors * law.std_error || law.first_loss > kErrors * law.first_error;
  if (lost && law.slope > kErrors * law.slope_error)
    return is(RecoveryVerdict::recovering, RecoveryReason::none);
  // Blame the largest part of the variance of the slope, or of the loss if that is the unknown.
  const bool of_slope = law.loss > kErrors * law.std_error;
  const int which = of_slope ? kOfSlope : kOfLevel;
  const double variance = fit.covariance(which, which);
  if (fit.noise_only[which] > 0.5 * variance)
    return is(RecoveryVerdict::not_known, RecoveryReason::inexact);
  double baseline = 0;
  for (std::size_t s = 0; s < kSources; ++s) {
    const int b = kOfBaseline + static_cast<int>(s);
    baseline += fit.covariance(which, b) * fit.covariance(which, b);
  }
  const double curve = fit.covariance(which, kOfCurve) * fit.covariance(which, kOfCurve);
  is(RecoveryVerdict::not_known,
     baseline > curve ? RecoveryReason::baseline : RecoveryReason::amplitude);
}

bool Recovery::renewal_due(Time now) {
  if (!active_ || renewed_ >= kRenew_s.size()) return false;
  const double since_s = seconds_of(now - began_);
  if (since_s < kRenew_s[renewed_] || newest_s_ <= (renewed_ > 0 ? kRenew_s[renewed_ - 1] : 0))
    return false;
  while (renewed_ < kRenew_s.size() && since_s >= kRenew_s[renewed_]) ++renewed_;
  return true;
}

}  // namespace framewatch::estimator
