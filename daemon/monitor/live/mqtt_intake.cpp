// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/mqtt_intake.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/secret_file.h"
#include "daemon/monitor/live/mqtt_payload.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kLeastBetweenLines_us = 60 * kSecond_us;

}  // namespace

std::vector<std::string> mqtt_topics(const Config& config) {
  std::vector<std::string> out;
  for (const WeatherSettings& w : config.weather)
    if (!w.mqtt.empty() && std::ranges::find(out, w.mqtt) == out.end()) out.push_back(w.mqtt);
  return out;
}

MqttIntake::MqttIntake(const Config& config)
    : covariates_(config.weather),
      source_(*config.mqtt, mqtt_topics(config),
              [path = config.mqtt->password_file](std::string& trouble) {
                return read_secret(path, trouble);
              }),
      since_us_(host_clock_us()) {}

void MqttIntake::poll(Estimation& estimation, std::int64_t now_us) {
  const bool was_connected = state_.connected;
  state_ = source_.state();
  if (state_.connected != was_connected) since_us_ = now_us;
  for (const drivers::MqttMessage& message : source_.take()) take(message, estimation, now_us);
  log_change(steady_clock_us());
}

void MqttIntake::take(const drivers::MqttMessage& message, Estimation& estimation,
                      std::int64_t now_us) {
  bool old = false;
  std::string problem;
  for (std::size_t c = 0; c < covariates_.size(); ++c) {
    const WeatherSettings& covariate = covariates_[c];
    if (covariate.mqtt != message.topic) continue;
    if (message.retained && covariate.time_field.empty()) {
      old = true;
    } else if (const auto reading = read_mqtt_payload(message.payload, covariate, problem)) {
      estimation.weather_value(c, reading->value, reading->time_us);
    }
  }
  if (old) ++retained_;
  if (problem.empty()) return;
  ++unreadable_;
  unread_ = fmt::format("{}: {}", message.topic, problem);
  unread_log_(now_us, "MQTT: cannot read the payload of " + unread_);
}

/// Logs a change of the connection, at most one a minute.
void MqttIntake::log_change(std::int64_t steady_us) {
  Logged now = Logged::nothing;
  if (state_.connected)
    now = state_.trouble.empty() ? Logged::connected : Logged::refused;
  else if (!state_.trouble.empty())
    now = Logged::away;
  if (now == logged_ || now == Logged::nothing) return;
  if (logged_ != Logged::nothing && steady_us < logged_us_ + kLeastBetweenLines_us) return;
  const std::string& broker = source_.settings().url;
  if (now == Logged::connected)
    log(LogLevel::notice, fmt::format("MQTT: connected to {}", broker));
  else if (now == Logged::away)
    log(LogLevel::warning,
        fmt::format(
            "MQTT: no connection to {}: {}. Its readings are missing; framewatch tries again "
            "at least once in {} s",
            broker, state_.trouble, drivers::MqttSource::kLongestPause_s));
  else
    log(LogLevel::warning,
        fmt::format("MQTT: {}: {}. Its readings are missing: check the broker's access rules",
                    broker, state_.trouble));
  logged_ = now;
  logged_us_ = steady_us;
}

mqtt_status_t MqttIntake::status(std::int64_t now_us) const {
  mqtt_status_t out{};
  out.time_us = now_us;
  out.broker = source_.settings().url;
  out.connected = state_.connected ? 1 : 0;
  out.since_us = since_us_;
  out.trouble = state_.trouble;
  out.connections = state_.connections;
  out.messages = state_.messages;
  out.dropped = state_.dropped;
  out.retained = retained_;
  out.unreadable = unreadable_ + state_.too_long;
  out.unread = unread_;
  return out;
}

}  // namespace framewatch::daemon
