// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/daily_well.h"

#include <atomic>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include <framewatch/service_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/actions/notifier.h"
#include "daemon/monitor/actions/quiet_hours.h"
#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/history_fixture.h"

namespace framewatch::daemon {
namespace daily_well_test {

std::int64_t at(const char* text) {
  return *read_utc(text);
}

TEST(DailyTime, IsDueOnceADayAfterItsTime) {
  DailyTime time("08:00", "UTC");
  EXPECT_FALSE(time.due(at("2026-11-28T07:00:00Z")));
  EXPECT_FALSE(time.due(at("2026-11-28T07:59:59Z")));
  EXPECT_TRUE(time.due(at("2026-11-28T08:00:00Z")));
  EXPECT_FALSE(time.due(at("2026-11-28T08:00:01Z")));
  EXPECT_FALSE(time.due(at("2026-11-29T07:59:59Z")));
  EXPECT_TRUE(time.due(at("2026-11-29T19:00:00Z")));  // the machine slept
  EXPECT_FALSE(time.due(at("2026-11-29T19:00:01Z")));
}

TEST(DailyTime, AProgramThatStartsLaterWaitsForTheNextDay) {
  DailyTime late("08:00", "UTC");
  EXPECT_FALSE(late.due(at("2026-11-28T08:05:00Z")));
  EXPECT_FALSE(late.due(at("2026-11-28T23:59:59Z")));
  EXPECT_TRUE(late.due(at("2026-11-29T08:00:00Z")));
  DailyTime restarted("08:00", "UTC");
  EXPECT_TRUE(restarted.due(at("2026-11-28T08:04:00Z")));
  DailyTime none("", "UTC");
  EXPECT_FALSE(none.due(at("2026-11-28T08:00:00Z")));
}

TEST(WellEvent, NamesWhatIsNotWell) {
  Config config;
  Heard heard(config);
  const std::int64_t now_us = at("2026-11-28T08:00:00Z");
  EXPECT_EQ(well_event(heard, config, now_us).message,
            "not well: no messages of framewatch run arrive on LCM");
  service_t service{};
  service.started_us = now_us - 7200 * kSecond_us;
  service.version = FRAMEWATCH_VERSION;
  service.received_us = now_us;
  service.disk_free_bytes = -1;
  service.name = {"base", "floor1"};
  service.newest_us = {now_us, now_us};
  heard.service = service;
  const event_t well = well_event(heard, config, now_us);
  EXPECT_EQ(well.message, "all is well: 2 channels measure, running for 2 h 0 min");
  EXPECT_EQ(well.severity, severity::information);
  EXPECT_EQ(well.kind, kWellKind);
  heard.service->received_us = now_us - 600 * kSecond_us;
  heard.service->state_problem = "disk full";
  const event_t ill = well_event(heard, config, now_us);
  EXPECT_EQ(ill.severity, severity::warning);
  EXPECT_NE(ill.message.find("not well: no samples for 10 min 0 s; "), std::string::npos)
      << ill.message;
  EXPECT_NE(ill.message.find("disk full"), std::string::npos) << ill.message;
}

/// The daily message of a program that publishes on `url`.
class DailyWellTest : public testing::Test {
 protected:
  /// Reaches the time of the message.
  void begin(DailyWell& well, const std::string& url) {
    config_.actions.emplace();
    config_.actions->well_at = "08:00";
    config_.actions->time_zone = "UTC";
    well.configure(config_, url);
    EXPECT_FALSE(well.update(before_us_));
    EXPECT_FALSE(well.update(due_us_));
  }
  event_t message(const std::string& url) {
    DailyWell well;
    begin(well, url);
    std::optional<event_t> out;
    const auto ready = [&] { return (out = well.update(due_us_)).has_value(); };
    EXPECT_TRUE(test::comes_true(ready, kWellSoon));
    EXPECT_FALSE(well.update(due_us_ + kSecond_us));  // only one a day
    return out.value_or(event_t{});
  }

  static constexpr std::chrono::seconds kWellSoon{60};  // it listens for 10 s
  const std::int64_t before_us_ = at("2026-11-28T07:59:00Z"), due_us_ = at("2026-11-28T08:00:00Z");
  Config config_;
};

TEST_F(DailyWellTest, HearsTheProgramOnLcm) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::atomic<bool> stop = false;
  std::thread program([&] {
    lcm::LCM bus(config_.lcm.url);
    const std::int64_t started_us = host_clock_us() - 7210 * kSecond_us;
    while (!stop) {
      service_t s{};
      s.time_us = s.received_us = host_clock_us();
      s.started_us = started_us;
      s.version = FRAMEWATCH_VERSION;
      s.disk_free_bytes = -1;
      s.channels = 1;
      s.name = {"base"};
      s.newest_us = {s.time_us};
      bus.publish(config_.lcm.prefix + "SERVICE", &s);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  const event_t well = message("");
  stop = true;
  program.join();
  EXPECT_EQ(well.message, "all is well: 1 channels measure, running for 2 h 0 min");
  EXPECT_EQ(well.severity, severity::information);
}

TEST_F(DailyWellTest, SaysThatNothingIsHeard) {
  const event_t ill = message("memq://");
  EXPECT_EQ(ill.message, "not well: no messages of framewatch run arrive on LCM");
  EXPECT_EQ(ill.severity, severity::warning);
  const event_t deaf = message("nonsense://");
  EXPECT_TRUE(deaf.message.starts_with("not well: cannot listen on LCM: ")) << deaf.message;
}

TEST_F(DailyWellTest, StopsListeningWhenTheProgramStops) {
  constexpr double kLongestStop_s = 8;  // it would listen for 10 s
  EXPECT_LT(seconds_for([&] {
              DailyWell well;
              begin(well, "memq://");
            }),
            kLongestStop_s);
}

TEST(QuietHours, OnlySevereEventsPassAtNight) {
  EXPECT_EQ(QuietHours().least_severity(at("2026-11-28T23:00:00Z")), severity::information);
  ActionSettings settings;
  settings.quiet_hours = "22:00-07:00";
  settings.time_zone = "UTC";
  const QuietHours quiet(settings);
  EXPECT_EQ(quiet.least_severity(at("2026-11-28T23:00:00Z")), severity::alarm);
  EXPECT_EQ(quiet.least_severity(at("2026-11-28T07:00:00Z")), severity::information);
}

}  // namespace daily_well_test
}  // namespace framewatch::daemon
