// SPDX-License-Identifier: MIT
#include "estimator/years/sensor_suspicions.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kPerDay = 1 / (3 * WeatherLags::kYear_d);  // a sensor goes wrong every three years
constexpr double kUsualError = 1;  // of a wrong sensor, in units of a regressor: 10 degC
constexpr std::size_t kKept = 8;   // suspicions, the likeliest
constexpr double kProbable = 0.95;
constexpr double kKnown = 2;  // standard errors, for the same probability

}  // namespace

std::vector<double> SensorSuspicions::correct(std::vector<double> readings) const {
  for (std::size_t c = 0; c < readings.size(); ++c) readings[c] -= errors_[c].size;
  return readings;
}

void SensorSuspicions::push(double day, const WeatherLags& read, const std::vector<double>& means,
                            std::vector<LossEvidence>& series) {
  if (suspicions_.size() > kKept) judge(series);  // no series had a value since
  for (Suspicion& s : suspicions_) {
    std::vector<double> right = means;
    right[s.covariate] -= s.size;
    s.right.push(day, right);
  }
  for (std::size_t c = 0; c < means.size(); ++c) {
    if (!covariates_[c].freezes) continue;  // humidity, wind and use change as suddenly themselves
    const WeatherLags::Change change = read.change(c);
    if (change.size * change.size <= change.variance) continue;  // smaller ones explain nothing
    suspicions_.push_back({c, day, change.size, change.variance, read});
    suspicions_.back().right.take_back(c, change.size);
    for (LossEvidence& s : series) s.suspect();
  }
  weather_.clear();
  for (const Suspicion& s : suspicions_)
    weather_.push_back({s.right.regressors(), s.right.doubt()});
}

/// Returns the logarithm of the likelihood of everything with this suspicion over that without any,
/// times the chance of a wrong sensor. docs/equations.md (71).
double SensorSuspicions::weigh(std::size_t index, const std::vector<LossEvidence>& series) const {
  const Suspicion& s = suspicions_[index];
  const double unit = kUsualError * covariates_[s.covariate].scale;
  const double square = s.size * s.size, wide = s.variance + unit * unit;
  double out =
      std::log(kPerDay * std::sqrt(s.variance / wide)) + square / 2 * (1 / s.variance - 1 / wide);
  for (const LossEvidence& e : series) out += e.suspicion(index);
  return out;
}

void SensorSuspicions::judge(std::vector<LossEvidence>& series) {
  std::vector<double> weights;
  double all = 1, largest = 0;
  likeliest_.reset();
  for (std::size_t i = 0; i < suspicions_.size(); ++i) {
    weights.push_back(weigh(i, series));
    const double odds = std::exp(std::min(weights.back(), 300.0));
    all += odds;
    if (odds <= largest) continue;
    largest = odds;
    likeliest_ = i;
    log_odds_ = weights.back();
  }
  excuse_ = std::log(all);
  if (largest < kProbable * all) likeliest_.reset();
  while (suspicions_.size() > kKept) {
    const auto least = static_cast<std::size_t>(std::min_element(weights.begin(), weights.end()) -
                                                weights.begin());
    weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(least));
    if (likeliest_ && *likeliest_ > least) --*likeliest_;
    suspicions_.erase(suspicions_.begin() + static_cast<std::ptrdiff_t>(least));
    for (LossEvidence& s : series) s.drop_suspicion(least);
  }
}

void SensorSuspicions::adopt(double proof, WeatherLags& read, std::vector<LossEvidence>& series) {
  if (!likeliest_) return;
  double rival = 0;  // healthy elements and right sensors, or the likeliest loss
  for (const LossEvidence& s : series) rival = std::max(rival, s.log_capital());
  if (log_odds_ < proof + rival) return;
  read = suspicions_[*likeliest_].right;
  errors_ = with_likeliest();
  for (LossEvidence& s : series) s.adopt(*likeliest_);
  suspicions_.clear();
  weather_.clear();
  likeliest_.reset();
  excuse_ = 0;
}

/// Returns the proven errors with the one of the likeliest suspicion.
std::vector<SensorSuspicions::Error> SensorSuspicions::with_likeliest() const {
  std::vector<Error> out = errors_;
  if (!likeliest_) return out;
  const Suspicion& s = suspicions_[*likeliest_];
  Error& error = out[s.covariate];
  const bool back = error.size * s.size < 0;
  error = {s.day, error.size + s.size, error.variance + s.variance, true, back};
  return out;
}

std::optional<SensorSuspicions::Wrong> SensorSuspicions::wrong() const {
  std::optional<Wrong> out;
  double furthest = 0;
  const std::vector<Error> errors = with_likeliest();
  for (std::size_t c = 0; c < errors.size(); ++c) {
    const Error& e = errors[c];
    const double off = std::abs(e.size) / covariates_[c].scale, std_error = std::sqrt(e.variance);
    const bool mended = e.changed_back && std::abs(e.size) < kKnown * std_error;
    if (!e.wrong || mended || off <= furthest) continue;
    furthest = off;
    out = Wrong{c, e.since_day, e.size, std_error};
  }
  return out;
}

}  // namespace framewatch::estimator
