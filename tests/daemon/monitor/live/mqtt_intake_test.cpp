// SPDX-License-Identifier: MIT
// Tests the way of a reading from an MQTT broker into the estimation, its records and its status.
#include "daemon/monitor/live/mqtt_intake.h"

#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/weather_status_t.hpp>
#include <framewatch/weather_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/estimation/estimation.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/mqtt_broker.h"
#include "tests/support/recorded_table_test.h"

namespace framewatch::daemon {
namespace mqtt_intake_test {

constexpr std::int64_t kStart_us = 1'795'305'600 * kSecond_us;  // 2026-11-22T00:00:00Z

WeatherSettings covariate(const std::string& name, const std::string& topic,
                          const std::string& field = "", const std::string& time_field = "") {
  WeatherSettings out;
  out.name = name;
  out.mqtt = topic;
  out.field = field;
  out.time_field = time_field;
  return out;
}

Config config_for(const test::MqttBroker& broker) {
  std::vector<ConfigProblem> problems;
  Config out = *load_config(test::table_config(), problems);
  out.weather = {covariate("outside_degc", "roof/t"),
                 covariate("inside_degc", "room", "/temperature"),
                 covariate("humidity_pct", "room", "/humidity"),
                 covariate("wind_mps", "mast", "/wind", "/time")};
  out.mqtt = drivers::MqttSettings{};
  out.mqtt->url = broker.url();
  return out;
}

/// An estimation that keeps what it is given as records, and its newest status of weather.
struct Heard : EstimationListener {
  explicit Heard(const Config& config)
      : estimation(
            config,
            [this](std::int64_t, const std::string& channel,
                   const std::vector<std::uint8_t>& bytes) {
              if (channel.ends_with("WEATHER")) status = *drivers::decoded<weather_status_t>(bytes);
            },
            this) {
    pass_second();
  }
  void on_weather(const std::string& channel, std::int64_t time_us,
                  const std::vector<std::uint8_t>& bytes) override {
    records.push_back(*drivers::decoded<weather_t>(bytes));
    EXPECT_EQ(channel, "WEATHER");
    EXPECT_EQ(time_us, records.back().time_us);
  }
  void pass_second() {
    now_us += kSecond_us;
    estimation.sample({estimator::from_microseconds(now_us), 0, 0.0});
  }
  std::vector<weather_t> records;
  weather_status_t status{};
  std::int64_t now_us = kStart_us;
  Estimation estimation;
};

/// Lets the intake work until it is so.
bool await(MqttIntake& intake, Heard& heard, const std::function<bool()>& so) {
  for (int i = 0; i < 6000; ++i) {
    intake.poll(heard.estimation, host_clock_us());
    if (so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(MqttIntake, ReadingsArriveAsWeather) {
  test::MqttBroker broker;
  const Config config = config_for(broker);
  Heard heard(config);
  MqttIntake intake(config);
  ASSERT_TRUE(await(intake, heard, [&] { return broker.topics().size() == 3; }));
  EXPECT_EQ(broker.topics(), (std::vector<std::string>{"roof/t", "room", "mast"}));
  broker.publish("roof/t", "4.5");
  broker.publish("room", R"({"temperature": 21, "humidity": 40})");
  broker.publish("mast", R"({"wind": 7, "time": "2026-11-21T23:59:00Z"})", true);
  ASSERT_TRUE(await(intake, heard, [&] { return heard.records.size() == 4; }));
  heard.pass_second();
  heard.pass_second();
  EXPECT_EQ(heard.status.value, (std::vector<double>{4.5, 21, 40, 7}));
  EXPECT_EQ(heard.status.accepted, (std::vector<std::int64_t>{1, 1, 1, 1}));
  EXPECT_EQ(heard.records[0].name, "outside_degc");
  EXPECT_EQ(heard.records[0].time_us, kStart_us + kSecond_us);
  EXPECT_EQ(heard.records[3].time_us, kStart_us - 60 * kSecond_us);
  const mqtt_status_t status = intake.status(host_clock_us());
  EXPECT_EQ(status.broker, broker.url());
  EXPECT_EQ(status.connected, 1);
  EXPECT_EQ(status.trouble, "");
  EXPECT_EQ(status.messages, 3);
  EXPECT_EQ(status.retained + status.unreadable + status.dropped, 0);
}

TEST(MqttIntake, RecordsGiveTheSameStateAgain) {
  test::MqttBroker broker;
  const Config config = config_for(broker);
  Heard live(config), replayed(config);
  MqttIntake intake(config);
  ASSERT_TRUE(await(intake, live, [&] { return broker.topics().size() == 3; }));
  for (const char* degc : {"4.5", "400", "4.6"}) {
    broker.publish("roof/t", degc);
    const std::size_t before = live.records.size();
    ASSERT_TRUE(await(intake, live, [&] { return live.records.size() == before + 1; }));
    const auto bytes = drivers::encoded(live.records.back());
    replayed.estimation.message("WEATHER", bytes.data(), bytes.size());
    for (int i = 0; i < 3; ++i) live.pass_second(), replayed.pass_second();
  }
  EXPECT_EQ(live.status.rejected[0], 1);
  EXPECT_EQ(drivers::encoded(live.status), drivers::encoded(replayed.status));
}

TEST(MqttIntake, IgnoresRetainedReadingsWithoutATimeAndUnreadableOnes) {
  test::MqttBroker broker;
  const Config config = config_for(broker);
  Heard heard(config);
  MqttIntake intake(config);
  ASSERT_TRUE(await(intake, heard, [&] { return broker.topics().size() == 3; }));
  broker.publish("roof/t", "4.5", true);
  broker.publish("room", R"({"temperature": 21, "humidity": "?"})");
  broker.publish("mast", R"({"wind": 7})", true);
  broker.publish("roof/t", "unavailable");
  ASSERT_TRUE(await(intake, heard,
                    [&] { return intake.status(0).unreadable == 3 && !heard.records.empty(); }));
  const mqtt_status_t status = intake.status(0);
  EXPECT_EQ(status.retained, 1);
  EXPECT_EQ(status.unread, "roof/t: \"unavailable\" is not a number");
  ASSERT_EQ(heard.records.size(), 1u);
  EXPECT_EQ(heard.records[0].name, "inside_degc");
}

TEST(MqttIntake, TellsABrokerThatIsAwayOnce) {
  const int port = test::MqttBroker().port();
  Config config = config_for(test::MqttBroker());
  config.mqtt->url = "mqtt://127.0.0.1:" + std::to_string(port);
  Heard heard(config);
  testing::internal::CaptureStderr();
  MqttIntake intake(config);
  const auto until = steady_clock_us() + 4 * kSecond_us;  // three attempts
  ASSERT_TRUE(await(intake, heard, [&] {
    return steady_clock_us() > until && !intake.status(0).trouble.empty();
  }));
  const std::string text = testing::internal::GetCapturedStderr();
  const std::string line = "MQTT: no connection to mqtt://127.0.0.1";
  EXPECT_NE(text.find(line), std::string::npos) << text;
  EXPECT_EQ(text.find(line, text.find(line) + 1), std::string::npos) << text;
  EXPECT_EQ(intake.status(0).connected, 0);
  EXPECT_EQ(intake.status(0).trouble, "Connection refused");
}

}  // namespace mqtt_intake_test
}  // namespace framewatch::daemon
