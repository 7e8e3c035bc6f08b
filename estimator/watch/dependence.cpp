// SPDX-License-Identifier: MIT
#include "estimator/watch/dependence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kColdest_degc = -90, kHottest_degc = 150;  // outside: a broken thermometer

}  // namespace

Dependence::Dependence(std::size_t parameters)
    : at_(2 * parameters, 0.0), slope_(2 * parameters, 0.0), covariance_(3 * parameters, 0.0) {}

Dependence::Expected Dependence::expected(std::size_t p, const Conditions& now) const {
  const double* variance = &covariance_[3 * p];
  const auto off = [&](std::size_t i, double value) {
    return variance[i] > 0 ? value - at_[2 * p + i] : 0.0;
  };
  const double t = off(0, now.degc), a = off(1, now.log_amplitude);
  const double error = variance[0] * t * t + variance[1] * a * a + 2 * variance[2] * t * a;
  if (!std::isfinite(error)) return {1, std::numeric_limits<double>::infinity()};
  return {1 + slope_[2 * p] * t + slope_[2 * p + 1] * a, std::sqrt(std::max(error, 0.0))};
}

Dependence::Expected Dependence::change(std::size_t p, double from_degc, double to_degc) const {
  const double step = to_degc - from_degc;
  return {1 + slope_[2 * p] * step, std::sqrt(covariance_[3 * p]) * std::abs(step)};
}

Dependence::Slope Dependence::per_degc(std::size_t p) const {
  return {slope_[2 * p], std::sqrt(covariance_[3 * p])};
}

Dependence::Slope Dependence::per_log(std::size_t p) const {
  return {slope_[2 * p + 1], std::sqrt(covariance_[3 * p + 1])};
}

double Dependence::usual_per_degc(std::size_t p) const {
  const Slope slope = per_degc(p);
  return std::hypot(slope.value, slope.std_error);
}

DependenceLearner::DependenceLearner(int parameters, const DependenceOptions& options)
    : options_(options), sums_(static_cast<std::size_t>(parameters)) {}

double DependenceLearner::log_amplitude(const WindowEstimate& e, std::size_t p) {
  return e.snr[p] > 0 ? std::log(e.snr[p]) / 2 : kNaN;
}

bool DependenceLearner::push(const WindowEstimate& e, double degc) {
  if (complete() || (options_.temperature && std::isnan(degc)) || !windows_.take(e)) return false;
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    if (e.reason[p] != Observability::observable || !(e.std_error[p] > 0)) continue;
    Sum& sum = sums_[p];
    const double t = options_.temperature ? degc : 0;
    const double a = options_.amplitude ? log_amplitude(e, p) : 0;
    if (!std::isfinite(a)) continue;  // the noise is unknown or zero
    if (sum.count++ == 0) {
      sum.first = e.value[p];
      sum.first_degc = t;
      sum.first_log = a;
    }
    const double y = e.value[p] / sum.first - 1;
    const double error = e.std_error[p] / sum.first;
    const double weight = 1 / (error * error);
    const double x[] = {1, t - sum.first_degc, a - sum.first_log};
    for (std::size_t i = 0, at = 0; i < 3; ++i) {
      sum.right[i] += weight * x[i] * y;
      for (std::size_t j = i; j < 3; ++j) sum.normal[at++] += weight * x[i] * x[j];
    }
    sum.square += weight * y * y;
  }
  return complete();
}

DependenceLearner::Fit DependenceLearner::fit(const Sum& s) const {
  const auto& n = s.normal;
  const double mean[] = {n[1] / n[0], n[2] / n[0]};
  // Slopes are about the mean conditions; a condition that is not followed has a slope of 0 +- 0.
  constexpr double kNever = 1e30;
  const double m00 = n[3] - n[0] * mean[0] * mean[0] +
                     (options_.temperature ? 1 / (kUsualPerDegc * kUsualPerDegc) : kNever);
  const double m11 = n[5] - n[0] * mean[1] * mean[1] +
                     (options_.amplitude ? 1 / (kUsualPerLog * kUsualPerLog) : kNever);
  const double m01 = n[4] - n[0] * mean[0] * mean[1];
  const double y = s.right[0] / n[0];
  const double r0 = s.right[1] - mean[0] * s.right[0], r1 = s.right[2] - mean[1] * s.right[0];
  const double determinant = m00 * m11 - m01 * m01;
  const double slope0 = (m11 * r0 - m01 * r1) / determinant;
  const double slope1 = (m00 * r1 - m01 * r0) / determinant;
  const double left = s.square - s.right[0] * y - slope0 * r0 - slope1 * r1;
  const int freedom = s.count - 1 - (options_.temperature ? 1 : 0) - (options_.amplitude ? 1 : 0);
  const double excess = freedom > 0 ? std::max(left / freedom, 1.0) : 1.0;
  const double value = s.first * (1 + y);
  const double scale =
      1 / (1 + y);  // from slopes relative to the first value to slopes relative to this one
  Fit out{};
  out.value = value;
  out.std_error = s.first * std::sqrt(excess / n[0]);
  out.at = {s.first_degc + mean[0], s.first_log + mean[1]};
  out.slope = {options_.temperature ? scale * slope0 : 0.0,
               options_.amplitude ? scale * slope1 : 0.0};
  const double variance = excess * scale * scale / determinant;
  out.covariance = {options_.temperature ? variance * m11 : 0.0,
                    options_.amplitude ? variance * m00 : 0.0,
                    options_.temperature && options_.amplitude ? -variance * m01 : 0.0};
  return out;
}

Baseline DependenceLearner::baseline() const {
  Baseline out(sums_.size());
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    if (!windows_.most(sums_[p].count)) continue;
    const Fit f = fit(sums_[p]);
    out.value[p] = f.value;
    out.std_error[p] = f.std_error;
  }
  return out;
}

Dependence DependenceLearner::dependence() const {
  Dependence out(sums_.size());
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    if (!windows_.most(sums_[p].count)) continue;
    const Fit f = fit(sums_[p]);
    std::copy(f.at.begin(), f.at.end(), &out.at_[2 * p]);
    std::copy(f.slope.begin(), f.slope.end(), &out.slope_[2 * p]);
    std::copy(f.covariance.begin(), f.covariance.end(), &out.covariance_[3 * p]);
  }
  return out;
}

void MeanTemperature::push(Time time, double degc) {
  if (!(degc >= kColdest_degc && degc <= kHottest_degc)) return;
  const std::int64_t number = number_of(time);
  if (number < 0) return;
  Bin& bin = bins_[static_cast<std::size_t>(number % kBins)];
  if (bin.number != number) bin = {number, 0, 0};
  ++bin.count;
  bin.sum += degc;
}

double MeanTemperature::mean(Time start, Time end) const {
  const std::int64_t first = number_of(start), last = number_of(end);
  double sum = 0, before = kNaN;
  int count = 0;
  std::int64_t newest = first - kHolds - 1;
  for (const Bin& bin : bins_) {
    if (bin.count == 0 || bin.number <= newest || bin.number > last) continue;
    const double mean = bin.sum / static_cast<double>(bin.count);
    if (bin.number < first) {
      newest = bin.number;
      before = mean;
    } else {
      sum += mean;
      ++count;
    }
  }
  return count > 0 ? sum / count : before;
}

}  // namespace framewatch::estimator
