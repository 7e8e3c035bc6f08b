// SPDX-License-Identifier: MIT
#include "daemon/base/local_time.h"

#include <gtest/gtest.h>

#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace local_time_test {

std::int64_t at(const char* text) {
  return *read_utc(text);
}

TEST(LocalTime, ReadsTimesAndSpansOfADay) {
  EXPECT_EQ(read_clock_time("00:00"), 0);
  EXPECT_EQ(read_clock_time("23:59"), 1439);
  for (const char* wrong : {"", "8:00", "24:00", "12:60", "12.30", "ab:cd", "12:30 "})
    EXPECT_FALSE(read_clock_time(wrong)) << wrong;
  const auto night = read_daily_span("22:00-07:00");
  ASSERT_TRUE(night);
  EXPECT_TRUE(night->holds(22 * 60));
  EXPECT_TRUE(night->holds(0));
  EXPECT_TRUE(night->holds(7 * 60 - 1));
  EXPECT_FALSE(night->holds(7 * 60));
  EXPECT_FALSE(night->holds(12 * 60));
  const auto noon = read_daily_span("12:00-13:00");
  ASSERT_TRUE(noon);
  EXPECT_TRUE(noon->holds(12 * 60));
  EXPECT_FALSE(noon->holds(13 * 60));
  EXPECT_FALSE(noon->holds(0));
  for (const char* wrong : {"22:00", "22:00-22:00", "22:00-25:00", "22:00 07:00", "22:00-07:00x"})
    EXPECT_FALSE(read_daily_span(wrong)) << wrong;
}

TEST(LocalTime, ZonesHaveSummerTime) {
  EXPECT_FALSE(TimeZone::find(""));
  EXPECT_FALSE(TimeZone::find("Europe/Atlantis"));
  const auto utc = TimeZone::find("UTC");
  ASSERT_TRUE(utc);
  EXPECT_EQ(utc->minute_of_day(at("2026-07-01T21:30:00Z")), 21 * 60 + 30);
  const auto rome = TimeZone::find("Europe/Rome");
  if (!rome) GTEST_SKIP() << "no time zones on this machine";
  EXPECT_EQ(rome->minute_of_day(at("2026-01-01T21:30:00Z")), 22 * 60 + 30);
  EXPECT_EQ(rome->minute_of_day(at("2026-07-01T21:30:00Z")), 23 * 60 + 30);
  EXPECT_EQ(rome->day(at("2026-07-01T22:30:00Z")), "2026-07-02");
}

}  // namespace local_time_test
}  // namespace framewatch::daemon
