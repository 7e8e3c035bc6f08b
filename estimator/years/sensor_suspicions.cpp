// SPDX-License-Identifier: MIT
#include "estimator/years/sensor_suspicions.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kPerDay = 1 / (3 * WeatherLags::kYear_d);  // a sensor goes wrong every three years
constexpr double kUsualError = 1;  // of a wrong sensor, in units of a regressor: 10 degC
constexpr std::size_t kKept = 8;   // suspicions, likeliest first
constexpr double kProbable = 0.95;

}  // namespace

void SensorSuspicions::push(double day, const WeatherLags& read, const std::vector<double>& means,
                            std::vector<LossEvidence>& series) {
  if (suspicions_.size() > kKept) judge(series);  // no series had a value since
  for (Suspicion& s : suspicions_) {
    std::vector<double> right = means;
    right[s.covariate] -= s.size;
    s.right.push(day, right);
  }
  for (std::size_t c = 0; c < means.size(); ++c) {
    const WeatherLags::Change change = read.change(c);
    if (change.size * change.size <= change.variance) continue;  // smaller ones explain nothing
    suspicions_.push_back({c, day, change.size, change.variance, read});
    suspicions_.back().right.take_back(c, change.size);
    for (LossEvidence& s : series) s.suspect();
  }
  errors_.resize(read.regressors().size(), static_cast<Eigen::Index>(suspicions_.size()));
  for (Eigen::Index i = 0; i < errors_.cols(); ++i)
    errors_.col(i) =
        read.regressors() - suspicions_[static_cast<std::size_t>(i)].right.regressors();
}

/// Returns the logarithm of the likelihood of everything with this suspicion over that without any,
/// averaged over the prior of the error. docs/equations.md (71).
double SensorSuspicions::weigh(std::size_t index, const std::vector<LossEvidence>& series,
                               Wrong& wrong) const {
  const Suspicion& s = suspicions_[index];
  const double square = s.size * s.size, unit = kUsualError * covariates_[s.covariate].scale;
  const double prior = square / (unit * unit);
  LossEvidence::Likelihood all{square / s.variance + prior, square / s.variance};
  for (const LossEvidence& e : series) {
    const LossEvidence::Likelihood seen = e.suspicion(index);
    all.information += seen.information;
    all.score += seen.score;
  }
  const double factor = all.score / all.information;
  wrong = {s.covariate, s.day, factor * s.size, std::abs(s.size) / std::sqrt(all.information)};
  return (std::log(prior / all.information) + factor * all.score) / 2;
}

void SensorSuspicions::judge(std::vector<LossEvidence>& series) {
  std::vector<double> weights;
  double all = 1, largest = 0;
  wrong_.reset();
  for (std::size_t i = 0; i < suspicions_.size(); ++i) {
    Wrong wrong{};
    const double log = std::log(kPerDay) + weigh(i, series, wrong);
    weights.push_back(log);
    const double odds = std::exp(std::min(log, 300.0));
    all += odds;
    if (odds <= largest) continue;
    largest = odds;
    wrong_ = wrong;
  }
  excuse_ = std::log(all);
  if (largest < kProbable * all) wrong_.reset();
  while (suspicions_.size() > kKept) {
    const auto least = static_cast<std::size_t>(std::min_element(weights.begin(), weights.end()) -
                                                weights.begin());
    weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(least));
    suspicions_.erase(suspicions_.begin() + static_cast<std::ptrdiff_t>(least));
    for (LossEvidence& s : series) s.drop_suspicion(least);
  }
}

}  // namespace framewatch::estimator
