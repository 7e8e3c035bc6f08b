// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/weather_status_t.hpp>
#include <framewatch/weather_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/covariate_guard.h"

namespace framewatch::daemon {

/// Takes the readings of every covariate of [[weather]] from LCM messages and CAN frames, and tells
/// what is wrong with them. Uses sensor time only.
class WeatherIntake {
 public:
  /// `config` must outlive this.
  explicit WeatherIntake(const Config& config);

  bool any() const { return !guards_.empty(); }
  /// Returns true if a covariate takes weather_t messages from this LCM channel.
  bool hears(const std::string& channel) const;
  /// Returns true if a covariate takes temperature_t messages from this LCM channel.
  bool hears_thermometer(const std::string& channel) const;

  /// Takes a reading by name. now_us: newest sample of the accelerometers; 0: none yet, then the
  /// reading is ignored. Returns false if no covariate of that channel has the name.
  bool take(const std::string& channel, const weather_t& reading, std::int64_t now_us);
  void thermometer(const std::string& channel, std::int64_t time_us, double degc,
                   std::int64_t now_us);
  /// Takes a value without a name, of a CAN signal or an MQTT topic, in raw units. time_us: sensor
  /// time; absent: now_us. Returns the reading as a message for records, in raw units. Its name is
  /// empty if it was not taken: there was no sample yet, or, without a time, another one came less
  /// than a second ago.
  weather_t value(std::size_t covariate, double value, std::optional<std::int64_t> time_us,
                  std::int64_t now_us);

  /// Returns what has become known since the last call. Call it once a second.
  std::vector<event_t> update(std::int64_t now_us);
  /// Returns the state of every covariate, with the means since the last call.
  weather_status_t status(std::int64_t now_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(guards_);
    for (std::int32_t& told : told_) a.within(told, 0, kReadingTroubles - 1);
    for (std::int64_t& us : since_us_) a.within(us, -2 * a.kMaxCount, 2 * a.kMaxCount);
  }

 private:
  void take(std::size_t covariate, std::int64_t time_us, double raw, std::int64_t now_us);
  event_t event(std::size_t covariate, std::int64_t now_us);
  std::string words(std::size_t covariate, std::int64_t now_us) const;

  const Config& config_;
  std::vector<CovariateGuard> guards_;
  std::vector<std::int32_t> told_;      ///< ReadingTrouble of the last event, by covariate
  std::vector<std::int64_t> since_us_;  ///< when it was raised
};

}  // namespace framewatch::daemon
