// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/mqtt_status_t.hpp>

#include "daemon/base/log.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "drivers/mqtt/mqtt_source.h"

namespace framewatch::daemon {

/// Gives the readings of MQTT topics to the estimation. Logs when the broker goes and comes back,
/// and which payloads cannot be read.
class MqttIntake {
 public:
  /// `config` has [mqtt]. Connects at once, in a thread.
  explicit MqttIntake(const Config& config);

  /// Passes on what has come. Never waits.
  void poll(Estimation& estimation, std::int64_t now_us);
  /// Returns the state for viewers. `now_us`: host clock.
  mqtt_status_t status(std::int64_t now_us) const;

 private:
  void take(const drivers::MqttMessage& message, Estimation& estimation, std::int64_t now_us);
  void log_change(std::int64_t steady_us);

  const std::vector<WeatherSettings> covariates_;
  drivers::MqttSource source_;
  drivers::MqttState state_;   ///< newest
  std::int64_t since_us_ = 0;  ///< host clock since when state_.connected is so
  std::int64_t retained_ = 0, unreadable_ = 0;
  std::string unread_;
  /// States of the connection of which the log has a line.
  enum class Logged { nothing, connected, away, refused };
  Logged logged_ = Logged::nothing;
  std::int64_t logged_us_ = 0;  ///< steady clock of that line
  RateLimitedLog unread_log_{LogLevel::warning};
};

/// Returns the topics of the covariates, each once, in their order.
std::vector<std::string> mqtt_topics(const Config& config);

}  // namespace framewatch::daemon
