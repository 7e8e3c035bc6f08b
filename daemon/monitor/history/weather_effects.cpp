// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/weather_effects.h"

#include "daemon/base/clocks.h"
#include "daemon/monitor/history/history_days.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kNoon_us = kDay_us / 2;

}  // namespace

void WeatherEffects::find_mean() {
  if (weather.empty()) return;
  mean = Eigen::VectorXd::Zero(weather.begin()->second.size());
  for (const auto& [day, regressors] : weather) mean += regressors;
  mean /= static_cast<double>(weather.size());
}

double WeatherEffects::at(const std::string& element, std::int64_t time_us) const {
  const auto effect = by_element.find(element);
  if (effect == by_element.end() || weather.empty()) return estimator::kNaN;
  // The day whose noon was the last one.
  const std::int64_t before = floor_day(time_us - kNoon_us);
  const auto value = [&](const Eigen::VectorXd& regressors) {
    return effect->second.dot(regressors - mean);
  };
  auto a = weather.find(before);
  const auto b = weather.find(before + 1);
  if (a != weather.end() && b != weather.end()) {
    const double share =
        static_cast<double>(time_us - kNoon_us - before * kDay_us) / static_cast<double>(kDay_us);
    return (1 - share) * value(a->second) + share * value(b->second);
  }
  if (b != weather.end()) return value(b->second);
  if (a == weather.end()) a = weather.find(before - 1);
  if (a != weather.end()) return value(a->second);
  return estimator::kNaN;
}

double WeatherEffects::over(const std::string& element, std::int64_t from_us,
                            std::int64_t to_us) const {
  if (to_us - from_us < 2 * kDay_us) return at(element, from_us + (to_us - from_us) / 2);
  const auto effect = by_element.find(element);
  if (effect == by_element.end()) return estimator::kNaN;
  double sum = 0;
  int days = 0;
  for (auto d = weather.lower_bound(floor_day(from_us));
       d != weather.end() && d->first * kDay_us < to_us; ++d, ++days)
    sum += effect->second.dot(d->second - mean);
  return days > 0 ? sum / days : estimator::kNaN;
}

}  // namespace framewatch::daemon
