// SPDX-License-Identifier: MIT
// Tests the way of weather through the estimation: LCM messages and CAN frames in, status, events
// and records out.
#include <cmath>
#include <string>
#include <vector>

#include <framewatch/temperature_t.hpp>
#include <framewatch/weather_t.hpp>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/recorded_table_test.h"

namespace framewatch::daemon {
namespace weather_test {

constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z

Config table_with(const std::vector<WeatherSettings>& weather) {
  std::vector<ConfigProblem> problems;
  Config out = *load_config(test::table_config(), problems);
  out.weather = weather;
  return out;
}

WeatherSettings covariate(const std::string& name) {
  WeatherSettings w;
  w.name = name;
  w.away_after_s = 60;
  return w;
}

/// An estimation whose accelerometers sample once a minute, so that days pass quickly.
struct Heard : EstimationListener {
  explicit Heard(const Config& config)
      : estimation(
            config,
            [this](std::int64_t, const std::string& channel,
                   const std::vector<std::uint8_t>& bytes) {
              if (channel.ends_with("EVENT")) {
                auto e = *drivers::decoded<event_t>(bytes);
                if (e.kind == "weather") events.push_back(std::move(e));
              }
              if (channel.ends_with("WEATHER")) {
                status = *drivers::decoded<weather_status_t>(bytes);
                for (const double mean : status.mean) means += std::isfinite(mean);
              }
            },
            this) {}
  void on_weather(const std::string& channel, std::int64_t,
                  const std::vector<std::uint8_t>& bytes) override {
    records.push_back({channel, bytes});
  }
  /// Lets the sensors' time pass.
  void until(std::int64_t time_us) {
    for (; now_us < time_us; now_us += kSecond_us)
      estimation.sample({estimator::from_microseconds(now_us), 0, 0.0});
    estimation.sample({estimator::from_microseconds(now_us), 0, 0.0});
  }
  drivers::IntakeResult say(const std::string& name, double value,
                            const std::string& channel = "WEATHER") {
    weather_t m{};
    m.time_us = now_us;
    m.name = name;
    m.value = value;
    const auto bytes = drivers::encoded(m);
    return estimation.message(channel, bytes.data(), bytes.size());
  }

  struct Record {
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<event_t> events;
  weather_status_t status{};
  int means = 0;
  std::vector<Record> records;
  Estimation estimation;
  std::int64_t now_us = kStart_us;
};

TEST(Weather, ReadingsAreCountedConvertedAndKept) {
  WeatherSettings kelvin = covariate("roof_degc");
  kelvin.offset = 273.15;
  const Config config = table_with({covariate("humidity_pct"), kelvin});
  Heard heard(config);
  EXPECT_EQ(heard.say("humidity_pct", 50), drivers::IntakeResult::table);
  heard.until(kStart_us + 5 * kSecond_us);
  EXPECT_EQ(heard.status.value_us[0], 0);  // there was no sample yet, so no time
  EXPECT_EQ(heard.say("humidity_pct", 81.5), drivers::IntakeResult::table);
  EXPECT_EQ(heard.say("roof_degc", 283.15), drivers::IntakeResult::table);
  EXPECT_EQ(heard.say("nobody_pct", 1), drivers::IntakeResult::foreign);
  EXPECT_EQ(heard.estimation.message("WEATHER", "abc", 3), drivers::IntakeResult::malformed);
  heard.until(kStart_us + 10 * kSecond_us);
  ASSERT_EQ(heard.status.name, (std::vector<std::string>{"humidity_pct", "roof_degc"}));
  EXPECT_EQ(heard.status.value[0], 81.5);
  EXPECT_NEAR(heard.status.value[1], 10, 1e-9);
  EXPECT_EQ(heard.status.value_us[0], kStart_us + 5 * kSecond_us);
  EXPECT_EQ(heard.status.accepted, (std::vector<std::int64_t>{1, 1}));
  EXPECT_EQ(heard.means, 2);
  EXPECT_EQ(heard.records.size(), 3u);
  EXPECT_TRUE(heard.events.empty());
}

TEST(Weather, AThermometerIsACovariate) {
  WeatherSettings roof = covariate("roof_degc");
  roof.thermometer = "ROOF";
  const Config config = table_with({roof});
  Heard heard(config);
  heard.until(kStart_us + 2 * kSecond_us);
  const auto bytes = drivers::encoded(temperature_t{heard.now_us, 4.5});
  EXPECT_EQ(heard.estimation.message("ROOF", bytes.data(), bytes.size()),
            drivers::IntakeResult::table);
  heard.until(kStart_us + 4 * kSecond_us);
  EXPECT_EQ(heard.status.value[0], 4.5);
  ASSERT_EQ(heard.records.size(), 1u);
  EXPECT_EQ(heard.records[0].channel, "ROOF");
}

TEST(Weather, EventsTellWhatIsWrongAndWhenItIsOver) {
  const Config config = table_with({covariate("outside_degc")});
  Heard heard(config);
  heard.until(kStart_us);
  const auto say_each_10_s = [&](double degc) {
    heard.until(heard.now_us + 10 * kSecond_us);
    heard.say("outside_degc", degc);
  };
  for (int i = 0; i < 5; ++i) say_each_10_s(4 + 0.1 * i);
  for (int i = 0; i < 5; ++i) say_each_10_s(277);
  heard.until(heard.now_us + 2 * kSecond_us);
  ASSERT_EQ(heard.events.size(), 1u);
  EXPECT_EQ(heard.events[0].state, event_state::raised);
  EXPECT_EQ(heard.events[0].severity, severity::warning);
  EXPECT_EQ(heard.events[0].place, "outside_degc");
  EXPECT_EQ(heard.events[0].message,
            "readings of outside_degc are impossible: 277 is not between -60 and 80 degC. They do "
            "not count, and the last value stands for them. Check their unit");
  for (int i = 0; i < 3; ++i) say_each_10_s(4);
  heard.until(heard.now_us + 2 * kSecond_us);
  ASSERT_EQ(heard.events.size(), 2u);
  EXPECT_EQ(heard.events[1].state, event_state::cleared);
  EXPECT_EQ(heard.events[1].id, heard.events[0].id);
  EXPECT_NE(heard.events[1].message.find("5 were rejected"), std::string::npos)
      << heard.events[1].message;
  heard.until(heard.now_us + 100 * kSecond_us);
  ASSERT_EQ(heard.events.size(), 3u);
  EXPECT_NE(heard.events[2].message.find("no reading of outside_degc for 1 min"), std::string::npos)
      << heard.events[2].message;
  EXPECT_NE(heard.estimation.raised().find("weather", "outside_degc"), nullptr);
}

TEST(Weather, CountsAreTheSameAfterAStateFile) {
  const Config config = table_with({covariate("outside_degc")});
  Heard before(config), after(config);
  before.until(kStart_us + 2 * kSecond_us);
  before.say("outside_degc", 4);
  before.say("outside_degc", 400);
  ASSERT_EQ(after.estimation.load(before.estimation.save()), "");
  after.now_us = before.now_us;
  after.until(after.now_us + 3 * kSecond_us);
  EXPECT_EQ(after.status.accepted[0], 1);
  EXPECT_EQ(after.status.value[0], 4);
}

}  // namespace weather_test
}  // namespace framewatch::daemon
