// SPDX-License-Identifier: MIT
#include "estimator/simulate/climate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {
namespace {

constexpr int kDay_h = 24;
constexpr double kYear_h = 365.25 * kDay_h;
// In a temperate climate the warmest day is in July and the warmest hour is 15 h.
constexpr double kSpring_h = 110 * kDay_h, kMorning_h = 9;
constexpr double kMean_pct = 70, kSeason_pct = 8, kRain_pct = 8, kDriest_pct = 15;
constexpr double kFront_h = 3 * kDay_h, kRain_h = 2 * kDay_h, kGusts_h = 12;
constexpr double kGustiness = 0.6;  // deviation of the logarithm of the wind
constexpr double kWandering_h = 10 * kDay_h, kDrying_h = 8 * kDay_h;
constexpr int kWorkBegins_h = 8, kWorkEnds_h = 18;

double kept_after_an_hour(double hours) {
  return std::exp(-1 / hours);
}

/// 1970-01-01 was a Thursday.
bool is_workday(std::int64_t day) {
  const std::int64_t since_monday = ((day + 3) % 7 + 7) % 7;
  return since_monday < 5;
}

}  // namespace

ClimateStream::Wander::Wander(double deviation, double hours)
    : deviation_(deviation), kept_(kept_after_an_hour(hours)) {}

double ClimateStream::Wander::next(Random& random) {
  now_ = kept_ * now_ + deviation_ * std::sqrt(1 - kept_ * kept_) * random.normal();
  return now_;
}

ClimateStream::ClimateStream(const Climate& climate, int elements, double start_s,
                             std::uint64_t seed)
    : climate_(climate),
      hour_(static_cast<std::int64_t>(std::floor(start_s / kStep_s))),
      random_(seed),
      front_(climate.front_degc, kFront_h),
      rain_(kRain_pct, kRain_h),
      gusts_(kGustiness, kGusts_h),
      alike_(climate.wander_alike_ratio, kWandering_h) {
  const auto own = [&](double mean) {
    return mean * (1 + climate.spread_ratio * random_.normal());
  };
  for (int e = 0; e < elements; ++e) {
    const double lag_days =
        climate.shortest_lag_days +
        (climate.longest_lag_days - climate.shortest_lag_days) * random_.uniform();
    elements_.push_back({own(climate.per_degc), own(climate.frozen_per_degc), own(climate.per_pct),
                         own(climate.per_mps), kept_after_an_hour(lag_days * kDay_h),
                         Wander(climate.wander_ratio, kWandering_h), 0});
  }
  factor_.resize(elements_.size(), 1);
}

const WeatherHour& ClimateStream::next() {
  const auto hour = static_cast<double>(hour_);
  const double season = std::sin(2 * std::numbers::pi * (hour - kSpring_h) / kYear_h);
  const double daytime = std::sin(2 * std::numbers::pi * (hour - kMorning_h) / kDay_h);
  weather_.outside_degc = climate_.mean_degc + climate_.season_degc * season +
                          climate_.day_degc * daytime + front_.next(random_);
  weather_.humidity_pct =
      std::clamp(kMean_pct - kSeason_pct * season + rain_.next(random_), kDriest_pct, 100.0);
  weather_.wind_mps =
      climate_.mean_wind_mps * std::exp(gusts_.next(random_) - kGustiness * kGustiness / 2);
  const auto day = static_cast<std::int64_t>(std::floor(hour / kDay_h));
  const std::int64_t of_day = hour_ - day * kDay_h;
  const bool occupied = is_workday(day) && of_day >= kWorkBegins_h && of_day < kWorkEnds_h;
  weather_.occupied_pct = occupied ? 100 : 0;

  const double dried = kept_after_an_hour(kDrying_h);
  damp_pct_ = began_ ? weather_.humidity_pct + (damp_pct_ - weather_.humidity_pct) * dried
                     : kMean_pct - kSeason_pct * season;
  const double alike = alike_.next(random_);
  const double heavier = occupied ? 1 + climate_.occupied_mass_ratio : 1;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    Element& element = elements_[e];
    element.degc =
        began_ ? weather_.outside_degc + (element.degc - weather_.outside_degc) * element.lag_kept
               : climate_.mean_degc + climate_.season_degc * season;
    factor_[e] = std::exp(element.per_degc * (element.degc - climate_.mean_degc) +
                          element.frozen_per_degc * std::min(element.degc, 0.0) +
                          element.per_pct * (damp_pct_ - kMean_pct) +
                          element.per_mps * (weather_.wind_mps - climate_.mean_wind_mps) +
                          element.own.next(random_) + alike) /
                 heavier;
  }
  began_ = true;
  ++hour_;
  return weather_;
}

double ClimateStream::damping_factor(int element) const {
  return std::pow(factor_[static_cast<std::size_t>(element)], climate_.damping_exponent);
}

}  // namespace framewatch::estimator
