// SPDX-License-Identifier: MIT
#include "estimator/watch/change_point.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/solve/uncertainty.h"
#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

/// Degrees of freedom of a window's standard error, which comes from the scores of blocks.
constexpr double kErrorFreedom = BatchMeans::kBlocks - 1;

/// Sums over the first windows of a series; the difference of two gives any stretch.
struct Sums {
  double count = 0, weight = 0, value = 0, square = 0;  ///< values minus the first one
  double weight_square = 0;

  Sums operator-(const Sums& o) const {
    return {count - o.count, weight - o.weight, value - o.value, square - o.square,
            weight_square - o.weight_square};
  }
  double scatter() const { return std::max(square - value * value / weight, 0.0); }
  /// Returns the factor by which the variance of the mean exceeds 1 / weight, because the errors
  /// that set the weights are estimates themselves. Source: P. Meier, Variance of a weighted mean,
  /// Biometrics 9 (1953), 59.
  double variance_of_weights() const {
    return 1 + 4 / kErrorFreedom * (1 - weight_square / (weight * weight));
  }
};

std::vector<Sums> running_sums(const std::vector<WindowValue>& values, double& origin) {
  origin = kNaN;
  std::vector<Sums> out(1);
  for (const WindowValue& v : values) {
    Sums sum = out.back();
    if (std::isfinite(v.value) && v.std_error > 0) {
      if (std::isnan(origin)) origin = v.value;
      const double weight = 1 / (v.std_error * v.std_error), off = v.value - origin;
      sum.count += 1;
      sum.weight += weight;
      sum.value += weight * off;
      sum.square += weight * off * off;
      sum.weight_square += weight * weight;
    }
    out.push_back(sum);
  }
  return out;
}

/// excess: variance of the values over what their errors predict.
WindowMean mean(const Sums& s, double origin, double excess) {
  if (s.count == 0) return {kNaN, kNaN, 0};
  return {origin + s.value / s.weight,
          std::sqrt(std::max(excess, 1.0) * s.variance_of_weights() / s.weight),
          static_cast<int>(s.count)};
}

/// Returns the weighted squares that a straight line leaves of the values outside of `skipped`. A
/// slow drift, such as the temperature's, does not count as a step.
double left_by_line(const std::vector<WindowValue>& values, std::size_t skipped) {
  double weight = 0, t = 0, v = 0, tt = 0, tv = 0, vv = 0;
  const double origin = values.front().value;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == skipped || !std::isfinite(values[i].value) || !(values[i].std_error > 0)) continue;
    const double w = 1 / (values[i].std_error * values[i].std_error);
    const double x = seconds_of(values[i].start - values.front().start);
    const double y = values[i].value - (std::isfinite(origin) ? origin : 0);
    weight += w, t += w * x, v += w * y, tt += w * x * x, tv += w * x * y, vv += w * y * y;
  }
  const double across = tt - t * t / weight, along = tv - t * v / weight;
  return vv - v * v / weight - (across > 0 ? along * along / across : 0);
}

}  // namespace

double ratio_error(const WindowMean& before, const WindowMean& after) {
  return std::hypot(after.std_error, after.value / before.value * before.std_error) /
         std::abs(before.value);
}

double ChangePoint::errors() const {
  return std::abs(after.value - before.value) / std::hypot(before.std_error, after.std_error);
}

WindowMean mean_of(const std::vector<WindowValue>& values, std::size_t from, std::size_t to) {
  double origin = 0;
  const std::vector<Sums> sums = running_sums(values, origin);
  const Sums s = sums[to] - sums[from];
  return mean(s, origin, s.count > 1 ? s.scatter() / (s.count - 1) : 1);
}

std::optional<ChangePoint> find_change(const std::vector<WindowValue>& values,
                                       double least_change) {
  constexpr std::size_t kFewestAfter = 2;
  constexpr double kFewest = 4, kOfLine = 0.7;
  double origin = 0, left = 0;
  const std::vector<Sums> sums = running_sums(values, origin);
  std::optional<ChangePoint> best;
  for (std::size_t end = 1; end + 1 + kFewestAfter <= values.size(); ++end) {
    const Sums before = sums[end], after = sums.back() - sums[end + 1];
    if (before.count < 1 || after.count < kFewestAfter || before.count + after.count < kFewest)
      continue;
    const double scatter = before.scatter() + after.scatter();
    const double excess = scatter / (before.count + after.count - 2);
    const ChangePoint point{end, end + 1, mean(before, origin, excess),
                            mean(after, origin, excess)};
    if (!(std::abs(point.ratio()) >= least_change) || point.errors() < kChangeErrors) continue;
    if (best && point.errors() <= best->errors()) continue;
    best = point;
    left = scatter;
  }
  if (best && left > kOfLine * left_by_line(values, best->before_end)) return std::nullopt;
  return best;
}

}  // namespace framewatch::estimator
