// SPDX-License-Identifier: MIT
#include "estimator/watch/amplitude_curve.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

/// Standard deviation of the curve about the baseline's value; a larger one costs digits.
constexpr double kLevel = 0.05;
constexpr double kChance = 2;  // standard errors of an excess that counts as chance

}  // namespace

double AmplitudeCurve::covariance(double a, double b) const {
  const double x = a - origin_, y = b - origin_;
  double walk = 0;
  if (x * y > 0) {
    const double least = std::min(std::abs(x), std::abs(y));
    walk = least * least * (3 * std::max(std::abs(x), std::abs(y)) - least) / 6;
  }
  return kLevel * kLevel + kUsualPerLog * kUsualPerLog * x * y + kBend * kBend * walk;
}

AmplitudeCurve::AmplitudeCurve(double value, double own_error,
                               const std::vector<AmplitudePoint>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  if (n == 0) return;
  own_error_ = own_error;
  double weight = 0, mean = 0;
  for (const AmplitudePoint& point : points) {
    const double w = 1 / (point.std_error * point.std_error);
    at_.push_back(std::log(point.amplitude_m));
    weight += w;
    mean += w * at_.back();
  }
  origin_ = mean / weight;
  Eigen::MatrixXd matrix(n, n);
  Eigen::VectorXd off(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const AmplitudePoint& point = points[static_cast<std::size_t>(i)];
    off[i] = point.value / value - 1;
    for (Eigen::Index j = 0; j < n; ++j)
      matrix(i, j) = covariance(at_[static_cast<std::size_t>(i)], at_[static_cast<std::size_t>(j)]);
    matrix(i, i) += point.std_error * point.std_error / (value * value);
  }
  const Eigen::MatrixXd inverse = estimator::inverse(matrix);
  const Eigen::VectorXd weights = inverse * off;
  weights_.assign(weights.data(), weights.data() + n);
  inverse_.assign(inverse.data(), inverse.data() + n * n);
}

AmplitudeCurve::Expected AmplitudeCurve::expected(double amplitude_m) const {
  if (spans()) return at_log(std::log(amplitude_m));
  const double beyond = std::max({amplitude_m / highest_m(), lowest_m() / amplitude_m, 1.0});
  return {1, std::hypot(own_error_, kUsualPerLog * std::log(beyond))};
}

bool AmplitudeCurve::spans() const {
  return highest_m() >= kSpan * lowest_m();
}

double AmplitudeCurve::lowest_m() const {
  return std::exp(*std::min_element(at_.begin(), at_.end()));
}

double AmplitudeCurve::highest_m() const {
  return std::exp(*std::max_element(at_.begin(), at_.end()));
}

double AmplitudeCurve::least(double amplitude_m, double errors) const {
  const Expected e = expected(std::max(amplitude_m, lowest_m()));
  return e.ratio - errors * std::max(e.std_error - own_error_, 0.0);
}

double AmplitudeCurve::most(double amplitude_m, double errors) const {
  const Expected e = expected(std::min(amplitude_m, highest_m()));
  return e.ratio + errors * std::max(e.std_error - own_error_, 0.0);
}

AmplitudeCurve::Expected AmplitudeCurve::at_log(double log) const {
  std::array<double, AmplitudeBins::kBins> with{};
  const std::size_t n = at_.size();
  double off = 0, explained = 0;
  for (std::size_t i = 0; i < n; ++i) {
    with[i] = covariance(log, at_[i]);
    off += weights_[i] * with[i];
    double row = 0;
    for (std::size_t j = 0; j <= i; ++j) row += (i == j ? 1 : 2) * inverse_[i * n + j] * with[j];
    explained += with[i] * row;
  }
  return {1 + off, std::sqrt(std::max(covariance(log, log) - explained, 0.0))};
}

double AmplitudeCurve::slope(double amplitude_m) const {
  const double step = std::exp(AmplitudeBins::kStep / 2);
  return (expected(amplitude_m * step).ratio - expected(amplitude_m / step).ratio) /
         AmplitudeBins::kStep;
}

void AmplitudeBins::push(double amplitude_m, double off, double weight) {
  const double log = std::log(amplitude_m);
  if (!any()) first_log_ = log;
  const double place = (log - first_log_) / kStep + kBins / 2 + 0.5;
  Bin& bin = bins_[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 0.5))];
  const double x = log - first_log_;
  ++bin.count;
  bin.weight += weight;
  bin.log += weight * x;
  bin.off += weight * off;
  bin.log_square += weight * x * x;
  bin.off_square += weight * off * off;
  bin.log_off += weight * x * off;
}

bool AmplitudeBins::any() const {
  return std::any_of(bins_.begin(), bins_.end(), [](const Bin& b) { return b.count > 0; });
}

std::vector<AmplitudePoint> AmplitudeBins::points(double first) const {
  std::vector<AmplitudePoint> out;
  const Scatter scatter = this->scatter();
  for (const Bin& b : bins_)
    if (b.count > 0)
      out.push_back({std::exp(first_log_ + b.log / b.weight), first * (1 + b.off / b.weight),
                     first * std::sqrt(scatter.excess / b.weight + scatter.lasting)});
  return out;
}

double AmplitudeBins::excess() const {
  return scatter().excess;
}

/// Computes the scatter about lines, one a bin, that share one slope.
AmplitudeBins::Scatter AmplitudeBins::scatter() const {
  double across = 0, along = 0, square = 0, weight = 0;
  int freedom = -1, count = 0;
  for (const Bin& b : bins_) {
    if (b.count == 0) continue;
    across += b.log_square - b.log * b.log / b.weight;
    along += b.log_off - b.log * b.off / b.weight;
    square += b.off_square - b.off * b.off / b.weight;
    freedom += b.count - 1;
    weight += b.weight;
    count += b.count;
  }
  if (freedom <= 0) return {};
  const double left = square - (across > 0 ? along * along / across : 0);
  const double excess = std::max(left / freedom, 1.0);
  const double by_chance = 1 + kChance * std::sqrt(2.0 / freedom);
  return {excess, std::max(excess - by_chance, 0.0) * count / weight};
}

double RecentAmplitude::remembered(std::size_t i, double time_s) const {
  return amplitude_[i] * std::min(1.0, kHolds_s / std::max(time_s - time_s_[i], kHolds_s));
}

void RecentAmplitude::push(double time_s, double amplitude_m) {
  if (count_ > 0 && time_s < time_s_[count_ - 1]) return;
  while (count_ > 0 && amplitude_[count_ - 1] <= amplitude_m) --count_;
  if (count_ == kMax) {  // drop the smallest remembered one, except the newest
    std::size_t least = 0;
    for (std::size_t i = 1; i < count_; ++i)
      if (remembered(i, time_s) < remembered(least, time_s)) least = i;
    for (std::size_t i = least; i + 1 < count_; ++i) {
      time_s_[i] = time_s_[i + 1];
      amplitude_[i] = amplitude_[i + 1];
    }
    --count_;
  }
  time_s_[count_] = time_s;
  amplitude_[count_] = amplitude_m;
  ++count_;
}

double RecentAmplitude::at(double time_s) const {
  double largest = 0;
  for (std::size_t i = 0; i < count_; ++i) largest = std::max(largest, remembered(i, time_s));
  return largest;
}

}  // namespace framewatch::estimator
