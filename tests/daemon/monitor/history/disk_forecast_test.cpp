// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/disk_forecast.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_store.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace disk_forecast_test {

constexpr double kGb = 1e9;

HistorySettings keeps(double days, double gb) {
  HistorySettings out;
  out.keep_days = days;
  out.keep_gb = gb;
  return out;
}

TEST(DiskForecast, RawLogsGrowUpToTheirLimits) {
  // 1 GB a day; 10 GB are there.
  HistoryGrowth g{10 * kGb, 1 * kGb, 0, 15 * kGb};
  EXPECT_FALSE(days_until_full(keeps(30, 20), g));  // 10 GB more at most
  EXPECT_FALSE(days_until_full(keeps(20, 200), g));
  EXPECT_NEAR(*days_until_full(keeps(300, 200), g), 15, 1e-9);
  g.other_bytes_per_day = 1 * kGb;
  // 10 days with 2 GB a day leave nothing of 15 GB.
  EXPECT_NEAR(*days_until_full(keeps(30, 20), g), 7.5, 1e-9);
  g.free_bytes = 25 * kGb;
  EXPECT_NEAR(*days_until_full(keeps(30, 20), g), 15, 1e-9);
  g.free_bytes = 0;
  EXPECT_EQ(days_until_full(keeps(30, 20), g), 0);
}

TEST(DiskForecast, ASlowGrowthIsNoMatter) {
  EXPECT_FALSE(days_until_full(keeps(30, 20), {0, 0, 0, kGb}));
  EXPECT_FALSE(days_until_full(keeps(30, 20), {0, 0, kGb / 4000, kGb}));
  EXPECT_TRUE(days_until_full(keeps(30, 20), {0, 0, kGb / 3000, kGb}));
}

TEST(DiskForecast, SaysTheDay) {
  const std::int64_t now_us = *read_utc("2026-11-28T12:00Z");
  EXPECT_EQ(disk_sentence(40.2, now_us), "the disk is full in about 40 days (2027-01-07)");
  EXPECT_EQ(disk_sentence(1.0, now_us), "the disk is full in about 1 day (2026-11-29)");
  EXPECT_EQ(disk_sentence(std::nullopt, now_us), "the disk has room for 10 years or more");
}

TEST(DiskForecast, ReadsTheGrowthFromTheStoredFiles) {
  const test::TemporaryDirectory directory;
  HistorySettings s = keeps(30, 20);
  s.directory = directory.path("h");
  const std::int64_t first_us = *read_utc("2026-11-18T00:00Z"), now_us = first_us + 10 * kDay_us;
  EXPECT_FALSE(history_growth(s, now_us));
  SummaryStore store(s);
  ASSERT_EQ(store.open(), "");
  SummaryBatch batch;
  batch.parameters.name = {"kx_1_y1"};
  batch.parameters.unit = {"N/m"};
  batch.parameters.kind = {0};
  batch.parameters.story = {1};
  PeriodData data;
  data.start_us = first_us;
  data.last_us = first_us + 1;
  data.windows = 1;
  data.parameters.resize(1);
  batch.periods.push_back(data);
  ASSERT_EQ(store.add(batch), "");
  std::filesystem::create_directories(raw_folder(s.directory));
  for (const int day : {18, 19, 20, 21})
    test::write_file(
        raw_folder(s.directory) + "/202611" + std::to_string(day) + "T000000Z.lcmlog.zst",
        std::string(1000, 'x'));
  test::write_file(raw_folder(s.directory) + "/20261122T000000Z.lcmlog.partial",
                   std::string(9000, 'x'));
  const auto growth = history_growth(s, now_us);
  ASSERT_TRUE(growth);
  EXPECT_EQ(growth->raw_bytes, 4000);
  EXPECT_NEAR(growth->raw_bytes_per_day, 1000, 1e-6);
  EXPECT_GT(growth->other_bytes_per_day, 0);
  EXPECT_GT(growth->free_bytes, 0);
  EXPECT_FALSE(history_growth(s, first_us + kSecond_us));
}

}  // namespace disk_forecast_test
}  // namespace framewatch::daemon
