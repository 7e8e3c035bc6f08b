// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/daily_well.h"

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/actions/notifier.h"
#include "daemon/monitor/actions/quiet_hours.h"
#include "daemon/monitor/events/event_messages.h"

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
