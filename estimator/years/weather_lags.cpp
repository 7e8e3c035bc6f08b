// SPDX-License-Identifier: MIT
#include "estimator/years/weather_lags.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch::estimator {
namespace {

constexpr int kWaves = 2;          // of the season: a year and half a year
constexpr double kFrost_d = 2;     // lag of what freezes, days
constexpr double kChange = 0.3;    // usual change of a covariate from day to day, of its scale
constexpr double kForgets_d = 9;   // days after which an unknown covariate may be anything usual
constexpr double kSoon_d = 2.5;    // means further apart say little about a sudden change
constexpr double kChanges_d = 90;  // over which usual changes are learned

double toward(double from, double to, double days, double lag_d) {
  return lag_d > 0 ? to + (from - to) * std::exp(-days / lag_d) : to;
}

}  // namespace

WeatherLags::WeatherLags(const std::vector<Covariate>& covariates)
    : covariates_(covariates), past_(covariates.size()) {
  std::size_t regressors = 1;
  for (const Covariate& c : covariates_) regressors += std::size(kLags_d) + (c.freezes ? 1 : 0);
  if (covariates_.empty()) regressors += 2 * kWaves;
  regressors_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(regressors));
  regressors_[0] = 1;
}

void WeatherLags::push(double day, const std::vector<double>& means) {
  const double days = begun_ ? std::max(day - day_, 0.0) : 0;
  begun_ = true;
  day_ = day;
  for (std::size_t c = 0; c < covariates_.size(); ++c) {
    Past& past = past_[c];
    const double now = means[c];
    past.change.size = 0;
    if (std::isfinite(now)) {
      if (!past.known) {
        past.first = now;
        std::fill(std::begin(past.lagged), std::end(past.lagged), now);
        past.frost = std::min(now, 0.0);
        past.square = 2 * std::pow(kChange * covariates_[c].scale, 2);
      } else if (day - past.before_day < kSoon_d) {
        past.change = {now - past.before, past.square};
        past.square += (past.change.size * past.change.size - past.square) / kChanges_d;
      }
      past.before = past.known ? past.newest : now;
      past.before_day = past.known ? past.day : day;
      past.known = true;
      past.day = day;
      past.newest = now;
    }
    const double doubt = kChange * std::sqrt(std::min(day - past.day, kForgets_d));
    for (std::size_t i = 0; i < std::size(kLags_d); ++i) {
      past.lagged[i] = toward(past.lagged[i], past.newest, days, kLags_d[i]);
      past.doubt[i] = toward(past.doubt[i], doubt, days, kLags_d[i]);
    }
    past.frost = toward(past.frost, std::min(past.newest, 0.0), days, kFrost_d);
  }
  set_regressors();
}

void WeatherLags::set_regressors() {
  Eigen::Index r = 1;
  for (std::size_t c = 0; c < covariates_.size(); ++c) {
    const Past& past = past_[c];
    for (const double lagged : past.lagged)
      regressors_[r++] = (lagged - past.first) / covariates_[c].scale;
    if (covariates_[c].freezes) regressors_[r++] = past.frost / covariates_[c].scale;
  }
  if (!covariates_.empty()) return;
  for (int wave = 1; wave <= kWaves; ++wave) {
    const double angle = 2 * M_PI * wave * day_ / kYear_d;
    regressors_[r++] = std::cos(angle);
    regressors_[r++] = std::sin(angle);
  }
}

void WeatherLags::take_back(std::size_t covariate, double size) {
  Past& past = past_[covariate];
  past.newest -= size;
  for (std::size_t i = 0; i < std::size(kLags_d); ++i)
    past.lagged[i] -= toward(0, size, 1, kLags_d[i]);
  past.frost = toward(past.frost, std::min(past.newest, 0.0), 1, kFrost_d);
  set_regressors();
}

double WeatherLags::doubt() const {
  double variance = 0;
  for (const Past& past : past_) {
    if (!past.known) return std::numeric_limits<double>::infinity();
    variance += std::pow(*std::ranges::max_element(past.doubt), 2);
  }
  return std::sqrt(variance);
}

}  // namespace framewatch::estimator
