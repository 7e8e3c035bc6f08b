// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/progress.h"
#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace people_texts_test {

constexpr std::int64_t kMidnight_us = 1'795'305'600'000'000;  // 2026-11-22 00:00:00 UTC
constexpr std::int64_t kEvening_us = 1'795'291'200'000'000;   // 2026-11-21 20:00:00 UTC

std::string in_zone(const char* zone, std::int64_t time_us) {
  ::setenv("TZ", zone, 1);
  ::tzset();
  const std::string text = utc_and_local_text(time_us);
  ::unsetenv("TZ");
  ::tzset();
  return text;
}

TEST(UtcText, ReadsBackItsText) {
  EXPECT_EQ(utc_text(kMidnight_us), "2026-11-22T00:00:00Z");
  EXPECT_EQ(utc_text(kMidnight_us + 250'000), "2026-11-22T00:00:00.250Z");
  EXPECT_EQ(utc_text(-1'000'000), "1969-12-31T23:59:59Z");
  for (const char* text : {"2026-11-22T00:00:00Z", "2026-11-22", "2026-11-22 00:00",
                           "2026-11-22T00:00", "1795305600", "1795305600.0"})
    EXPECT_EQ(read_utc(text), kMidnight_us) << text;
  EXPECT_EQ(read_utc("2026-11-22T00:00:00.25Z"), kMidnight_us + 250'000);
  for (const char* text : {"", "yesterday", "2026-13-01", "2026-02-30", "2026-11-22T25:00", "nan",
                           "2026-11-22T00:61", "2026-11-22X", "1e300", "2026-11-22T00:00:"})
    EXPECT_FALSE(read_utc(text)) << text;
}

TEST(UtcText, ClampsYearsToFourDigits) {
  constexpr std::int64_t kFarthest = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(utc_text(kFarthest), "9999-12-31T23:59:59.999Z");
  EXPECT_EQ(utc_text(-kFarthest - 1), "0000-01-01T00:00:00Z");
  EXPECT_EQ(utc_stamp(kFarthest), "99991231T235959Z");
  EXPECT_EQ(sensor_time_text(kFarthest), "9999-12-31 23:59:59 UTC");
}

TEST(UtcAndLocalText, HasBothIfTheyDiffer) {
  EXPECT_EQ(in_zone("UTC", kEvening_us), "2026-11-21 20:00:00 UTC");
  EXPECT_EQ(in_zone("CET-1", kEvening_us), "2026-11-21 20:00:00 UTC (21:00:00 CET)");
  EXPECT_EQ(in_zone("JST-9", kEvening_us), "2026-11-21 20:00:00 UTC (2026-11-22 05:00:00 JST)");
}

TEST(TimeLeftText, RoundsToUsefulPrecision) {
  EXPECT_EQ(time_left_text(7.2), "8 s left");
  EXPECT_EQ(time_left_text(0), "0 s left");
  EXPECT_EQ(time_left_text(200), "4 min left");
  EXPECT_EQ(time_left_text(2 * 3600 + 590), "2 h 10 min left");
  EXPECT_EQ(time_left_text(-1), "0 s left");
}

}  // namespace people_texts_test
}  // namespace framewatch::daemon
