// SPDX-License-Identifier: MIT
#include <filesystem>

#include <framewatch/event_t.hpp>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_keeper.h"
#include "daemon/monitor/history/raw_history.h"
#include "daemon/monitor/history/summary_store.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_raw_test {

namespace fs = std::filesystem;
using test::comes_true;

// Limits.
constexpr std::chrono::seconds kSoon{60};  // the keeper's thread has idle priority

constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z
constexpr int kRate_hz = 100, kAxes = 10;

/// Feeds samples of `seconds`, from `from_s` after the start on, all different.
void feed(RawHistory& history, int from_s, int seconds) {
  for (int i = from_s * kRate_hz; i < (from_s + seconds) * kRate_hz; ++i)
    for (int axis = 0; axis < kAxes; ++axis)
      history.sample({estimator::from_microseconds(kStart_us + i * kSecond_us / kRate_hz), axis,
                      1e-6 * (i * kAxes + axis)});
}

std::size_t count_of(const std::vector<RawCount>& counts, std::int64_t first) {
  for (std::size_t i = 0; i < counts.size(); ++i)
    EXPECT_EQ(counts[i].count, first + static_cast<std::int64_t>(i)) << i;
  return counts.size();
}

void record(const Config& config, int from_s, int seconds) {
  HistoryKeeper keeper(*config.history);
  RawHistory raw(config, [&](auto log) { keeper.retire(std::move(log)); });
  feed(raw, from_s, seconds);
  raw.finish();
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const RawLog& log : raw_logs(folder)) names.push_back(fs::path(log.path).filename());
  return names;
}

TEST(RawHistory, ReadsBackEverySampleAcrossRotations) {
  const test::TemporaryDirectory directory;
  Config config = test::table_with_history(directory.path("h"));
  config.history->rotate_s = 2;
  config.history->compress = false;
  record(config, 1, 6);
  EXPECT_EQ(names_in(raw_folder(config.history->directory)),
            (std::vector<std::string>{"20261122T000001Z.lcmlog", "20261122T000002Z.lcmlog",
                                      "20261122T000004Z.lcmlog", "20261122T000006Z.lcmlog"}));
  EXPECT_EQ(count_of(test::raw_counts(config.history->directory), kRate_hz * kAxes), 6000u);
  const auto part = test::raw_counts(config.history->directory, kStart_us + 3 * kSecond_us,
                                     kStart_us + 5 * kSecond_us);
  EXPECT_EQ(count_of(part, 3 * kRate_hz * kAxes), 2000u);
}

TEST(RawHistory, RotatesBySizeAndNeverReusesAName) {
  const test::TemporaryDirectory directory;
  Config config = test::table_with_history(directory.path("h"));
  config.history->rotate_mb = 0.02;
  config.history->compress = false;
  record(config, 0, 5);
  record(config, 0, 5);  // the clock stepped back
  const auto logs = raw_logs(raw_folder(config.history->directory));
  EXPECT_GE(logs.size(), 4u);
  EXPECT_EQ(test::raw_counts(config.history->directory).size(), 10'000u);
}

TEST(RawHistory, WritesAnUnfinishedBlockSoon) {
  const test::TemporaryDirectory directory;
  const Config config = test::table_with_history(directory.path("h"));
  HistoryKeeper keeper(*config.history);
  RawHistory raw(config, [&](auto log) { keeper.retire(std::move(log)); });
  raw.sample({estimator::from_microseconds(kStart_us), 0, 1.0});
  raw.tick(0);
  raw.tick(100'000);
  raw.tick(300'000);
  EXPECT_TRUE(
      comes_true([&] { return test::raw_counts(config.history->directory).size() == 1; }, kSoon));
  raw.finish();
}

TEST(RawHistory, ReadsALogThatIsRenamedAfterListing) {
  const test::TemporaryDirectory directory;
  Config config = test::table_with_history(directory.path("h"));
  config.history->compress = false;
  record(config, 0, 1);
  const std::string path = raw_logs(raw_folder(config.history->directory)).at(0).path;
  const auto listed = [&] { return raw_logs_between(config.history->directory, 0, INT64_MAX / 2); };
  const auto samples = [](const std::vector<RawLog>& logs) {
    int count = 0;
    std::vector<std::string> notes;
    std::string problem;
    EXPECT_TRUE(read_raw_history(logs, 0, INT64_MAX / 2,
                                 {[](auto&, double) {}, [&](auto&) { ++count; }}, notes, problem))
        << problem;
    return count;
  };
  fs::rename(path, path + ".partial");
  const std::vector<RawLog> written = listed();
  fs::rename(path + ".partial", path);
  EXPECT_EQ(samples(written), kRate_hz * kAxes);
  const std::vector<RawLog> closed = listed();
  compress_raw_log(path, false);
  ASSERT_FALSE(fs::exists(path));
  EXPECT_EQ(samples(written), kRate_hz * kAxes);
  EXPECT_EQ(samples(closed), kRate_hz * kAxes);
  test::write_file(path + ".partial", "");  // listed while it is being renamed
  test::write_file(path, "");
  EXPECT_EQ(samples(listed()), kRate_hz * kAxes);
}

TEST(RawHistory, AStrayClockCreatesNoFile) {
  const test::TemporaryDirectory directory;
  const Config config = test::table_with_history(directory.path("h"));
  HistoryKeeper keeper(*config.history);
  {
    RawHistory raw(config, [&](auto log) { keeper.retire(std::move(log)); });
    feed(raw, 0, 1);
    for (int i = 0; i < 50; ++i) {
      raw.sample({estimator::from_microseconds(0), 1, 1.0});
      raw.sample({estimator::from_microseconds(kStart_us + kSecond_us + i), 0, 1.0});
    }
    raw.finish();
  }
  EXPECT_TRUE(comes_true(
      [&] {
        return names_in(raw_folder(config.history->directory)) ==
               std::vector<std::string>{"20261122T000000Z.lcmlog.zst"};
      },
      kSoon));
  EXPECT_EQ(test::raw_counts(config.history->directory).size(), 1100u);
}

TEST(HistoryKeeper, CompressesClosedLogsWithoutLoss) {
  const test::TemporaryDirectory directory;
  Config config = test::table_with_history(directory.path("h"));
  config.history->rotate_s = 2;
  HistoryKeeper keeper(*config.history);
  RawHistory raw(config, [&](auto log) { keeper.retire(std::move(log)); });
  feed(raw, 0, 6);
  EXPECT_TRUE(comes_true(
      [&] {
        return names_in(raw_folder(config.history->directory)) ==
               std::vector<std::string>{"20261122T000000Z.lcmlog.zst",
                                        "20261122T000002Z.lcmlog.zst",
                                        "20261122T000004Z.lcmlog.partial"};
      },
      kSoon));
  raw.finish();
  EXPECT_TRUE(comes_true([&] { return test::raw_counts(config.history->directory).size() == 6000; },
                         kSoon));
  count_of(test::raw_counts(config.history->directory), 0);
}

/// Returns a raw log in the state that a killed program leaves.
std::string killed_log(const Config& config) {
  record(config, 0, 4);
  const std::string path = raw_logs(raw_folder(config.history->directory)).at(0).path;
  const std::string partial = path + ".partial";
  fs::rename(path, partial);
  return partial;
}

TEST(RawLogCare, CutsOffOnlyTheIncompleteEvent) {
  const test::TemporaryDirectory directory;
  Config config = test::table_with_history(directory.path("h"));
  config.history->compress = false;
  const std::string partial = killed_log(config);
  const std::string path = partial.substr(0, partial.size() - 8);
  const std::string whole = test::read_file(partial);
  for (std::size_t torn = 1; torn < 60; torn += 7) {
    fs::remove(path);
    test::write_file(partial, whole.substr(0, whole.size() - torn));
    repair_raw_logs(raw_folder(config.history->directory));
    const std::string repaired = test::read_file(path);
    ASSERT_LT(repaired.size(), whole.size());
    EXPECT_GT(repaired.size(), whole.size() - 6000);
    EXPECT_EQ(repaired, whole.substr(0, repaired.size()));
    EXPECT_GE(test::raw_counts(config.history->directory).size(), 3700u);
  }
}

TEST(RawLogCare, LeavesAnOpenLogAlone) {
  const test::TemporaryDirectory directory;
  const Config config = test::table_with_history(directory.path("h"));
  HistoryKeeper keeper(*config.history);
  RawHistory raw(config, [&](auto log) { keeper.retire(std::move(log)); });
  feed(raw, 0, 1);
  const std::string folder = raw_folder(config.history->directory);
  ASSERT_TRUE(comes_true([&] { return names_in(folder).size() == 1; }, kSoon));
  repair_raw_logs(folder);
  EXPECT_EQ(names_in(folder), (std::vector<std::string>{"20261122T000000Z.lcmlog.partial"}));
  raw.finish();
}

TEST(RawLogCare, SetsEmptyLogsAside) {
  const test::TemporaryDirectory directory;
  const Config config = test::table_with_history(directory.path("h"));
  const std::string folder = raw_folder(config.history->directory);
  fs::create_directories(folder);
  test::write_file(folder + "/20261122T000000Z.lcmlog.partial", "");
  test::write_file(folder + "/20261122T000001Z.lcmlog.partial", std::string(100, 'x'));
  repair_raw_logs(folder);
  EXPECT_FALSE(fs::exists(folder + "/20261122T000000Z.lcmlog.partial"));
  EXPECT_EQ(test::read_file(folder + "/20261122T000001Z.lcmlog.damaged"), std::string(100, 'x'));
}

TEST(RawLogCare, AStoppedCompressionLeavesOnlyTheLog) {
  const test::TemporaryDirectory directory;
  Config config = test::table_with_history(directory.path("h"));
  config.history->compress = false;
  record(config, 0, 2);
  const std::string folder = raw_folder(config.history->directory);
  const std::string path = raw_logs(folder).at(0).path;
  const std::string before = test::read_file(path);
  compress_raw_log(path, true);
  EXPECT_EQ(names_in(folder), (std::vector<std::string>{"20261122T000000Z.lcmlog"}));
  EXPECT_FALSE(fs::exists(path + ".zst.partial"));
  EXPECT_EQ(test::read_file(path), before);
}

TEST(RawLogCare, RemovesLeftoversOfAKilledCompression) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("20261122T000000Z.lcmlog.zst.partial"), "half");
  test::write_file(directory.path("20261122T000000Z.lcmlog"), "whole");
  remove_unfinished_compressions(directory.path(""));
  EXPECT_EQ(directory.names(), (std::vector<std::string>{"20261122T000000Z.lcmlog"}));
}

/// Returns a history with ten logs of a second each, the first on the hour.
Config ten_logs(const std::string& directory) {
  Config config = test::table_with_history(directory);
  config.history->rotate_s = 1;
  config.history->compress = false;
  config.history->event_before_s = 0.5;
  config.history->event_after_s = 0.2;
  record(config, 0, 10);
  return config;
}

TEST(Retention, RemovesTheOldestBySize) {
  const test::TemporaryDirectory directory;
  Config config = ten_logs(directory.path("h"));
  const auto before = raw_logs(raw_folder(config.history->directory));
  ASSERT_EQ(before.size(), 10u);
  config.history->keep_gb = 1e-9 * static_cast<double>(4 * before[1].bytes);
  remove_old_raw_logs(*config.history, kStart_us + 10 * kSecond_us);
  const auto after = raw_logs(raw_folder(config.history->directory));
  ASSERT_GE(after.size(), 3u);
  ASSERT_LE(after.size(), 4u);
  EXPECT_EQ(after.back().path, before.back().path);
}

TEST(Retention, RemovesByAgeButKeepsLogsOfEvents) {
  const test::TemporaryDirectory directory;
  Config config = ten_logs(directory.path("h"));
  SummaryStore store(*config.history);
  ASSERT_EQ(store.open(), "");
  SummaryBatch batch;
  event_t event{};
  event.kind = "stiffness_change";
  event.state = 1;
  event.time_us = event.since_us = kStart_us + 4 * kSecond_us + kSecond_us / 2;
  batch.events = {event};
  event.kind = "bus_off";
  event.time_us = event.since_us = kStart_us + 2 * kSecond_us;
  batch.events.push_back(event);
  ASSERT_EQ(store.add(batch), "");

  const std::int64_t day_us = 86400 * kSecond_us;
  config.history->keep_days = 1;
  remove_old_raw_logs(*config.history, kStart_us + 8 * kSecond_us + day_us + 1);
  EXPECT_EQ(names_in(raw_folder(config.history->directory)),
            (std::vector<std::string>{"20261122T000008Z.lcmlog", "20261122T000009Z.lcmlog"}));
  EXPECT_EQ(names_in(event_folder(config.history->directory)),
            (std::vector<std::string>{"20261122T000004Z.lcmlog"}));
  const auto kept =
      test::raw_counts(config.history->directory, kStart_us, kStart_us + 6 * kSecond_us);
  // Whole blocks, of a quarter of a second.
  ASSERT_GE(kept.size(), 700u);
  EXPECT_LE(kept.size(), 1500u);
  count_of(kept, kept.front().count);
  EXPECT_LE(kept.front().time_us, kStart_us + 4 * kSecond_us);
  EXPECT_GE(kept.back().time_us, kStart_us + 4 * kSecond_us + 690'000);
}

TEST(Retention, RemovesNothingWhileEventsAreUnreadable) {
  const test::TemporaryDirectory directory;
  Config config = ten_logs(directory.path("h"));
  test::write_file(summary_file(config.history->directory), std::string(8192, 'x'));
  config.history->keep_gb = 1e-9;
  remove_old_raw_logs(*config.history, kStart_us);
  EXPECT_EQ(raw_logs(raw_folder(config.history->directory)).size(), 10u);
}

}  // namespace history_raw_test
}  // namespace framewatch::daemon
