// SPDX-License-Identifier: MIT
#include <filesystem>

#include <framewatch/history_status_t.hpp>

#include <gtest/gtest.h>

#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"
#include "daemon/monitor/live/run_command.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/full_disk.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_failure_test {

namespace fs = std::filesystem;
using test::comes_true;

// Limits.
constexpr std::chrono::seconds kSoon{60};  // the keeper's thread has idle priority
constexpr double kRecord_s = 8;
constexpr std::size_t kSamples = 8010;  // of its ten channels

struct Collected {
  std::vector<std::vector<std::uint8_t>> estimates;
  std::size_t main_windows = 0;
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    main_windows += channel == "FRAMEWATCH_ESTIMATE";
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    estimates.emplace_back(bytes, bytes + buffer->data_size);
  }
};

/// A live estimation in this process, over memq, with or without a history.
class Live {
 public:
  Live(const Config& config, History* history) : lcm_("memq://"), live_(config, lcm_) {
    lcm_.subscribe("FRAMEWATCH_ESTIMATE.*", &Collected::on_message, &collected_)
        ->setQueueCapacity(100'000);
    live_.record_to(history);
  }
  void play(const std::string& log) {
    drivers::LcmLogReader reader;
    ASSERT_TRUE(reader.open(log));
    drivers::LogEvent event;
    while (reader.next(event) == drivers::LogRead::event) {
      lcm_.publish(event.channel, event.data.data(), static_cast<unsigned>(event.data.size()));
      ASSERT_TRUE(live_.poll(0));
    }
    while (lcm_.handleTimeout(100) > 0) {
    }
  }
  const auto& estimates() const { return collected_.estimates; }
  std::size_t main_windows() const { return collected_.main_windows; }

 private:
  drivers::LcmProvider lcm_;
  Collected collected_;
  LiveEstimation live_;
};

class HistoryFailure : public testing::Test {
 protected:
  HistoryFailure()
      : log_(directory_.path("rec.lcmlog")),
        config_(test::table_with_history(directory_.path("h"))) {
    test::record_table_test(log_, kRecord_s);
    Live without(config_, nullptr);
    without.play(log_);
    expected_ = without.estimates();
    main_windows_ = without.main_windows();
  }
  const test::TemporaryDirectory directory_;
  const std::string log_;
  Config config_;
  std::vector<std::vector<std::uint8_t>> expected_;
  std::size_t main_windows_ = 0;
};

TEST_F(HistoryFailure, TheHistoryChangesNoByteOfTheEstimates) {
  {
    History history(config_);
    Live live(config_, &history);
    live.play(log_);
    EXPECT_GT(expected_.size(), 200u);
    EXPECT_TRUE(live.estimates() == expected_);
    EXPECT_EQ(history.status().raw_samples, static_cast<std::int64_t>(kSamples));
  }
  EXPECT_EQ(test::raw_counts(config_.history->directory).size(), kSamples);
}

TEST_F(HistoryFailure, RecoversFromAFullDisk) {
  {
    History history(config_);
    {
      Live live(config_, &history);
      live.play(log_);
      ASSERT_TRUE(comes_true([&] { return history.status().summary_commits > 0; }, kSoon));
    }
    history.tick(1);
    history.tick(1'000'000);
    ASSERT_TRUE(comes_true(
        [&] { return test::raw_counts(config_.history->directory).size() == kSamples; }, kSoon));
    HistoryMonitor monitor;
    EXPECT_TRUE(monitor.update(0, history.status()).empty());
    {
      const test::FullDisk full(
          fs::file_size(raw_logs(raw_folder(config_.history->directory))[0].path));
      Live live(config_, &history);
      live.play(log_);
      EXPECT_TRUE(live.estimates() == expected_);
      ASSERT_TRUE(comes_true([&] { return !history.status().raw_trouble.empty(); }, kSoon));
      const auto news = monitor.update(2'000'000, history.status());
      ASSERT_FALSE(news.empty());
      EXPECT_EQ(news.front().kind, "history");
      EXPECT_EQ(news.front().state, 1);
      EXPECT_TRUE(monitor.update(4'000'000, history.status()).empty()) << "alarmed once";
      EXPECT_EQ(test::raw_counts(config_.history->directory).size(), kSamples);
    }
    ASSERT_TRUE(comes_true(
        [&] {
          const history_status_t s = history.status();
          return s.raw_trouble.empty() && s.summary_trouble.empty() && s.raw_queue_bytes == 0;
        },
        kSoon));
    EXPECT_EQ(history.status().raw_dropped, 0) << "the queue kept data that the disk refused";
    EXPECT_TRUE(monitor.update(6'000'000, history.status()).empty());
    const auto over = monitor.update(20'000'000, history.status());
    ASSERT_FALSE(over.empty());
    EXPECT_EQ(over.front().state, 0);
  }
  EXPECT_EQ(test::raw_counts(config_.history->directory).size(), 2 * kSamples);
}

TEST_F(HistoryFailure, CountsDataThatTheQueueDrops) {
  fs::create_directories(config_.history->directory);
  test::write_file(raw_folder(config_.history->directory), "no folder");
  constexpr std::size_t kQueue = 20'000;
  RawHistory raw(
      config_, [](auto) {}, kQueue);
  for (int i = 0; i < 10'000; ++i)
    raw.sample({estimator::from_microseconds(10'000 * i), i % 10, 1.0});
  const RawHistory::Counters counters = raw.counters();
  EXPECT_EQ(counters.samples, 10'000);
  EXPECT_GT(counters.dropped, 5000);
  EXPECT_LE(counters.queued, kQueue);
}

TEST_F(HistoryFailure, BeginsAnotherRawLogWhenItsFileIsRemoved) {
  constexpr std::int64_t kSecond_us = 1'000'000;
  {
    HistoryKeeper keeper(*config_.history);
    RawHistory raw(config_, [&](auto log) { keeper.retire(std::move(log)); });
    std::int64_t time_us = 0, now_us = 0;
    const auto second = [&] {
      for (int i = 0; i < 100; ++i)
        raw.sample({estimator::from_microseconds(time_us += 10'000), 0, 1.0});
      raw.tick(now_us += kSecond_us);
    };
    second();
    const auto logs = [&] { return raw_logs(raw_folder(config_.history->directory)); };
    ASSERT_TRUE(comes_true([&] { return !logs().empty(); }, kSoon));
    EXPECT_EQ(raw.trouble(), "");
    fs::remove(logs().front().path);
    ASSERT_TRUE(comes_true(
        [&] {
          second();
          return !raw.trouble().empty();
        },
        kSoon));
    EXPECT_NE(raw.trouble().find("removed"), std::string::npos) << raw.trouble();
    second();
    ASSERT_TRUE(comes_true([&] { return !logs().empty(); }, kSoon));
    raw.tick(now_us += RawHistory::kTold_us + kSecond_us);
    EXPECT_EQ(raw.trouble(), "");
    raw.finish();
  }
  EXPECT_GE(test::raw_counts(config_.history->directory).size(), 100u);
}

TEST_F(HistoryFailure, WaitsForAMissingFolder) {
  test::write_file(config_.history->directory, "a file where the folder should be");
  History history(config_);
  Live live(config_, &history);
  live.play(log_);
  EXPECT_TRUE(live.estimates() == expected_);
  ASSERT_TRUE(comes_true(
      [&] {
        return !history.status().raw_trouble.empty() && !history.status().summary_trouble.empty();
      },
      kSoon));
  fs::remove(config_.history->directory);
  ASSERT_TRUE(comes_true(
      [&] {
        const history_status_t s = history.status();
        return s.raw_trouble.empty() && s.summary_trouble.empty() && s.summary_commits > 0 &&
               s.raw_queue_bytes == 0;
      },
      kSoon));
  EXPECT_GE(test::raw_counts(config_.history->directory).size(), 7700u);
  EXPECT_EQ(history.status().raw_dropped, 0);
}

TEST_F(HistoryFailure, WaitsForAWritableFolder) {
  fs::create_directory_symlink("/proc/self",
                               config_.history->directory);  // even root cannot write there
  History history(config_);
  Live live(config_, &history);
  live.play(log_);
  EXPECT_TRUE(live.estimates() == expected_);
  EXPECT_TRUE(comes_true([&] { return !history.status().raw_trouble.empty(); }, kSoon));
  fs::remove(config_.history->directory);
  EXPECT_TRUE(comes_true([&] { return history.status().raw_trouble.empty(); }, kSoon));
}

TEST_F(HistoryFailure, ASlowOrBusyDatabaseDelaysNoEstimate) {
  {
    History history(config_);
    // While it is created, one of two programs that open it may be refused.
    ASSERT_TRUE(comes_true(
        [&] {
          SqliteFile made;
          return made.open_to_read(summary_file(config_.history->directory)) &&
                 version_problem(made, history_schema()).empty();
        },
        kSoon));
    SqliteFile other;
    ASSERT_TRUE(other.open(summary_file(config_.history->directory)));
    ASSERT_TRUE(comes_true([&] { return other.execute("BEGIN IMMEDIATE"); }, kSoon));
    {
      Live live(config_, &history);
      live.play(log_);
      EXPECT_TRUE(live.estimates() == expected_);
    }
    EXPECT_EQ(history.status().summary_until_us, 0);
    ASSERT_TRUE(comes_true([&] { return !history.status().summary_trouble.empty(); }, kSoon));
    ASSERT_TRUE(other.execute("ROLLBACK"));
    EXPECT_TRUE(comes_true([&] { return history.status().summary_until_us > 0; }, kSoon));
    EXPECT_EQ(history.status().summary_trouble, "");
    EXPECT_EQ(history.status().summary_dropped, 0);
  }
  SqliteFile file;
  ASSERT_TRUE(file.open_to_read(summary_file(config_.history->directory)));
  SqliteStatement windows = file.prepare("SELECT sum(windows) FROM period WHERE period_s = 1");
  ASSERT_TRUE(windows.row());
  EXPECT_EQ(windows.integer(0), static_cast<std::int64_t>(main_windows_));
}

TEST(HistoryMonitor, RaisesAnAlarmForASlowDiskThatLosesSamples) {
  HistoryMonitor monitor;
  history_status_t s{};
  s.time_us = 5;
  EXPECT_TRUE(monitor.update(0, s).empty());
  s.raw_dropped = 40;
  const auto raised = monitor.update(1'000'000, s);
  ASSERT_EQ(raised.size(), 1u);
  EXPECT_EQ(raised.front().place, "raw");
  EXPECT_EQ(raised.front().value, 40);
  EXPECT_NE(raised.front().message.find("too slow"), std::string::npos);
  for (int second = 2; second < 6; ++second)
    EXPECT_TRUE(monitor.update(second * 1'000'000, s).empty());
  EXPECT_EQ(monitor.update(20'000'000, s).at(0).state, 0);
}

}  // namespace history_failure_test
}  // namespace framewatch::daemon
