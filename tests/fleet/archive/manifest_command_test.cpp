// SPDX-License-Identifier: MIT
#include "fleet/archive/manifest_command.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/history/history_keeper.h"
#include "daemon/monitor/history/raw_history.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace manifest_command_test {

using daemon::kSecond_us;

constexpr std::int64_t kHour_us = 3600 * kSecond_us;
constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z

/// Writes raw logs of these hours after the start. Each lasts an hour if the next one follows.
std::vector<ArchiveLog> hours(const std::vector<int>& begins) {
  std::vector<ArchiveLog> out;
  for (const int h : begins)
    out.push_back({std::to_string(h), kStart_us + h * kHour_us, kStart_us + (h + 1) * kHour_us,
                   "digest " + std::to_string(h)});
  return out;
}

ArchivePlan plan(int length_h, std::int64_t warm_up_s) {
  return {"/c.toml", "/out", length_h * std::int64_t{3600}, warm_up_s, "p-c"};
}

TEST(ArchiveLogs, TasksStartAtMultiplesWithTheirLogs) {
  const auto tasks = plan_tasks(plan(2, 600), hours({1, 2, 3, 4}));
  ASSERT_EQ(tasks.size(), 3u);
  EXPECT_EQ(tasks[0].from_us, kStart_us);
  EXPECT_EQ(tasks[0].to_us, kStart_us + 2 * kHour_us);
  EXPECT_EQ(tasks[0].warm_up_us, kStart_us - 600 * kSecond_us);
  // The last windows of a task come a few samples later, so the next log is needed too.
  EXPECT_EQ(tasks[0].logs, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(tasks[1].logs, (std::vector<std::string>{"1", "2", "3", "4"}));
  EXPECT_EQ(tasks[2].logs, (std::vector<std::string>{"3", "4"}));
  EXPECT_EQ(tasks[1].number, 2);
  EXPECT_EQ(tasks[1].out, "/out/20261122T020000Z");
  EXPECT_NE(tasks[0].key, tasks[1].key);
}

TEST(ArchiveLogs, CreateNoTaskWithoutALog) {
  const auto tasks = plan_tasks(plan(1, 0), hours({0, 1000000}));
  ASSERT_EQ(tasks.size(), 2u);
  EXPECT_EQ(tasks[1].from_us, kStart_us + 1000000 * kHour_us);
  EXPECT_TRUE(plan_tasks(plan(1, 0), {}).empty());
}

TEST(ArchiveLogs, AcceptTimesBefore1970) {
  const auto tasks = plan_tasks(plan(1, 60), {{"old", -1'500'000, -500'000, ""}});
  ASSERT_EQ(tasks.size(), 1u);
  EXPECT_EQ(tasks[0].from_us, -kHour_us);
  EXPECT_EQ(tasks[0].to_us, 0);
}

TEST(ArchiveLogs, TakeTheClosedRawLogsOfAHistory) {
  const test::TemporaryDirectory directory;
  const daemon::Config config = test::table_with_history(directory.path("h"));
  std::filesystem::create_directories(directory.path("h/raw"));
  for (const char* name : {"20261122T010000Z.lcmlog.zst", "20261122T020000Z.lcmlog",
                           "20261122T030000Z.lcmlog.partial", "notes.txt"})
    test::write_file(directory.path(std::string("h/raw/") + name), "x");
  for (const char* place : {"h", "h/raw"}) {
    std::vector<std::string> problems;
    auto logs = archive_logs({directory.path(place)}, config, problems);
    EXPECT_TRUE(problems.empty());
    ASSERT_EQ(logs.size(), 2u) << place;
    EXPECT_TRUE(logs[0].path.ends_with("20261122T010000Z.lcmlog.zst"));
    EXPECT_EQ(logs[0].start_us, kStart_us + kHour_us);
    EXPECT_EQ(logs[0].end_us, kStart_us + 2 * kHour_us + kSecond_us);  // names are rounded down
    EXPECT_EQ(logs[1].end_us, kStart_us + 26 * kHour_us);              // unreadable
    add_digests(logs, problems);
    EXPECT_TRUE(problems.empty());
    EXPECT_EQ(logs[0].sha256.size(), 64u);
  }
}

TEST(ArchiveLogs, FindTheTimeOfOtherLogsByReading) {
  const test::TemporaryDirectory directory;
  const daemon::Config config = test::table_with_history(directory.path("h"));
  test::record_table_test(directory.path("rec.lcmlog"));
  std::vector<std::string> problems;
  const auto logs = archive_logs({directory.path("rec.lcmlog")}, config, problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(logs.size(), 1u);
  EXPECT_NEAR(static_cast<double>(logs[0].end_us - logs[0].start_us), 12e6, 0.1e6);
}

TEST(ArchiveLogs, FindTheEndOfTheLastRawLogByReading) {
  const test::TemporaryDirectory directory;
  daemon::Config config = test::table_with_history(directory.path("h"));
  config.history->compress = false;
  {
    daemon::HistoryKeeper keeper(*config.history);
    daemon::RawHistory raw(config, [&](auto log) { keeper.retire(std::move(log)); });
    for (int i = 0; i < 500; ++i)
      raw.sample({estimator::from_microseconds(kStart_us + i * 10'000), 0, 0.1});
    raw.finish();
  }
  std::vector<std::string> problems;
  const auto logs = archive_logs({directory.path("h")}, config, problems);
  ASSERT_EQ(logs.size(), 1u);
  EXPECT_EQ(logs[0].start_us, kStart_us);
  EXPECT_EQ(logs[0].end_us, kStart_us + 499 * 10'000 + 1);
}

TEST(ArchiveLogs, ReportEveryProblemAtOnce) {
  const test::TemporaryDirectory directory;
  const daemon::Config config = test::table_with_history(directory.path("h"));
  std::filesystem::create_directories(directory.path("empty"));
  test::write_file(directory.path("20261122T010000Z.lcmlog"), "x");
  test::write_file(directory.path("20261122T020000Z.a\tb.lcmlog"), "x");
  std::vector<std::string> problems;
  archive_logs(
      {directory.path("none.lcmlog"), directory.path("empty"),
       directory.path("20261122T010000Z.lcmlog"), directory.path("20261122T010000Z.lcmlog"),
       directory.path("20261122T020000Z.a\tb.lcmlog")},
      config, problems);
  ASSERT_EQ(problems.size(), 4u);
  EXPECT_NE(problems[0].find("none.lcmlog"), std::string::npos);
  EXPECT_NE(problems[1].find("has no closed raw log"), std::string::npos);
  EXPECT_NE(problems[2].find("is given twice"), std::string::npos);
  EXPECT_NE(problems[3].find("a tab"), std::string::npos);
}

}  // namespace manifest_command_test
}  // namespace framewatch::fleet
