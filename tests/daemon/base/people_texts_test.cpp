#include <cstdlib>
#include <ctime>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/progress.h"
#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace people_texts_test {

constexpr std::int64_t kEvening_us = 1'795'291'200'000'000;  // 2026-11-21 20:00:00 UTC

std::string in_zone(const char* zone, std::int64_t time_us) {
  ::setenv("TZ", zone, 1);
  ::tzset();
  const std::string text = utc_and_local_text(time_us);
  ::unsetenv("TZ");
  ::tzset();
  return text;
}

TEST(UtcAndLocalText, HasBothWhereTheyDiffer) {
  EXPECT_EQ(in_zone("UTC", kEvening_us), "2026-11-21 20:00:00 UTC");
  EXPECT_EQ(in_zone("CET-1", kEvening_us), "2026-11-21 20:00:00 UTC (21:00:00 CET)");
  EXPECT_EQ(in_zone("JST-9", kEvening_us), "2026-11-21 20:00:00 UTC (2026-11-22 05:00:00 JST)");
}

TEST(TimeLeftText, IsAsExactAsAPersonWants) {
  EXPECT_EQ(time_left_text(7.2), "8 s left");
  EXPECT_EQ(time_left_text(0), "0 s left");
  EXPECT_EQ(time_left_text(200), "4 min left");
  EXPECT_EQ(time_left_text(2 * 3600 + 590), "2 h 10 min left");
  EXPECT_EQ(time_left_text(-1), "0 s left");
}

}  // namespace people_texts_test
}  // namespace framewatch::daemon
