// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/weather_intake.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/events/warning_event.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFirstWeatherId = std::int64_t{1} << 43;

std::string duration_text(std::int64_t us) {
  const double s = 1e-6 * std::abs(static_cast<double>(us));
  if (s < 5400) return fmt::format("{:.0f} min", s / 60);
  if (s < 172'800) return fmt::format("{:.1f} h", s / 3600);
  return fmt::format("{:.1f} days", s / 86'400);
}

}  // namespace

WeatherIntake::WeatherIntake(const Config& config) : config_(config) {
  for (const WeatherSettings& w : config.weather) guards_.emplace_back(w);
  told_.resize(guards_.size());
  since_us_.resize(guards_.size());
}

bool WeatherIntake::hears(const std::string& channel) const {
  return std::ranges::find(config_.weather, channel, &WeatherSettings::lcm_channel) !=
         config_.weather.end();
}

bool WeatherIntake::hears_thermometer(const std::string& channel) const {
  return !channel.empty() &&
         std::ranges::find(config_.weather, channel, &WeatherSettings::thermometer) !=
             config_.weather.end();
}

void WeatherIntake::take(std::size_t covariate, std::int64_t time_us, double raw,
                         std::int64_t now_us) {
  const WeatherSettings& w = config_.weather[covariate];
  if (now_us != 0) guards_[covariate].take(time_us, w.scale * raw - w.offset, now_us);
}

bool WeatherIntake::take(const std::string& channel, const weather_t& reading,
                         std::int64_t now_us) {
  for (std::size_t c = 0; c < guards_.size(); ++c) {
    const WeatherSettings& w = config_.weather[c];
    if (w.lcm_channel != channel || w.name != reading.name) continue;
    take(c, reading.time_us, reading.value, now_us);
    return true;
  }
  return false;
}

void WeatherIntake::thermometer(const std::string& channel, std::int64_t time_us, double degc,
                                std::int64_t now_us) {
  for (std::size_t c = 0; c < guards_.size(); ++c)
    if (config_.weather[c].thermometer == channel) take(c, time_us, degc, now_us);
}

weather_t WeatherIntake::value(std::size_t covariate, double value,
                               std::optional<std::int64_t> time_us, std::int64_t now_us) {
  weather_t out{};
  if (covariate >= guards_.size() || now_us == 0) return out;
  const std::int64_t before_us = guards_[covariate].heard_us();
  if (!time_us && before_us != 0 && now_us >= before_us &&
      now_us < before_us + CovariateGuard::kLeast_us)
    return out;
  out.time_us = time_us.value_or(now_us);
  take(covariate, out.time_us, value, now_us);
  out.name = config_.weather[covariate].name;
  out.value = value;
  return out;
}

std::string WeatherIntake::words(std::size_t covariate, std::int64_t now_us) const {
  const CovariateGuard& g = guards_[covariate];
  const std::string& name = config_.weather[covariate].name;
  const CovariateUnit& unit = *covariate_unit(name);
  const char* const stands = "They do not count, and the last value stands for them";
  switch (g.trouble()) {
    case ReadingTrouble::none:
      return fmt::format("readings of {} count again; {} were rejected so far", name, g.rejected());
    case ReadingTrouble::away:
      return fmt::format(
          "no reading of {} for {}. The last value stands for it, and the errors "
          "of years grow. Check the sensor and its gateway",
          name, duration_text(now_us - g.trouble_since_us()));
    case ReadingTrouble::impossible:
      return fmt::format(
          "readings of {} are impossible: {:.5g} is not between {} and {} {}. {}. "
          "Check their unit",
          name, g.refused(), unit.least, unit.most, unit.unit, stands);
    case ReadingTrouble::future:
    case ReadingTrouble::past:
      return fmt::format(
          "readings of {} are stamped {} {} the accelerometers' time. {}. Check the "
          "clocks",
          name, duration_text(g.refused_us() - now_us),
          g.trouble() == ReadingTrouble::future ? "ahead of" : "behind", stands);
    case ReadingTrouble::jump:
      return fmt::format(
          "{} jumped from {:.5g} to {:.5g} {}. The new readings do not count. Check "
          "their unit; a sensor at another place needs another name",
          name, g.value(), g.refused(), unit.unit);
    case ReadingTrouble::stuck:
      return fmt::format("{} has read exactly {:.5g} {} for {}. {}. Check the sensor", name,
                         g.value(), unit.unit, duration_text(g.refused_us() - g.same_since_us()),
                         stands);
  }
  return {};
}

event_t WeatherIntake::event(std::size_t covariate, std::int64_t now_us) {
  const CovariateGuard& g = guards_[covariate];
  const bool was_raised = told_[covariate] != 0, over = g.trouble() == ReadingTrouble::none;
  if (!was_raised) since_us_[covariate] = g.trouble_since_us();
  const std::string& name = config_.weather[covariate].name;
  event_t out =
      warning_event({"weather", name, kFirstWeatherId + static_cast<std::int64_t>(covariate),
                     since_us_[covariate]},
                    over         ? event_state::cleared
                    : was_raised ? event_state::changed
                                 : event_state::raised,
                    now_us);
  out.value = g.value();
  out.unit = covariate_unit(name)->unit;
  out.message = words(covariate, now_us);
  told_[covariate] = static_cast<std::int32_t>(g.trouble());
  return out;
}

std::vector<event_t> WeatherIntake::update(std::int64_t now_us) {
  std::vector<event_t> out;
  for (std::size_t c = 0; c < guards_.size(); ++c) {
    guards_[c].tell(now_us);
    if (static_cast<std::int32_t>(guards_[c].trouble()) != told_[c])
      out.push_back(event(c, now_us));
  }
  return out;
}

weather_status_t WeatherIntake::status(std::int64_t now_us) {
  weather_status_t out{};
  out.time_us = now_us;
  out.covariates = static_cast<std::int32_t>(guards_.size());
  for (std::size_t c = 0; c < guards_.size(); ++c) {
    CovariateGuard& g = guards_[c];
    const CovariateGuard::Mean mean = g.take_mean();
    out.name.push_back(config_.weather[c].name);
    out.value.push_back(g.value());
    out.value_us.push_back(g.value_us());
    out.mean.push_back(mean.value);
    out.mean_us.push_back(mean.newest_us);
    out.accepted.push_back(g.accepted());
    out.rejected.push_back(g.rejected());
  }
  return out;
}

}  // namespace framewatch::daemon
