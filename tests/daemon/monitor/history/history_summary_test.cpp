// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include <framewatch/event_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_history.h"
#include "daemon/monitor/history/summary_store.h"
#include "drivers/files/encoded.h"
#include "tests/daemon/monitor/history/summary_program.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_summary_test {

// Limits.
constexpr double kRounding = 1e-12;  // of sums over at most 10,000 values

/// Computes the summary of the windows [from, to) directly and compares.
void expect_summary(const Row& row, std::size_t p, std::int64_t from, std::int64_t to) {
  std::vector<double> values, box, squares;
  for (std::int64_t i = from; i < to; ++i) {
    const window_estimate_t e = window(i);
    if (e.reason[p] != 0) continue;
    values.push_back(e.value[p]);
    squares.push_back(e.std_error[p] * e.std_error[p]);
    if (i % 10 == 0) box.push_back(e.value[p]);  // a tenth of a window apart
  }
  const auto n = static_cast<double>(values.size());
  EXPECT_EQ(row.windows, to - from);
  EXPECT_EQ(row.observable, static_cast<std::int64_t>(values.size()));
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  EXPECT_NEAR(row.mean, mean, kRounding * mean);
  EXPECT_NEAR(row.std_error, std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / n),
              kRounding * row.std_error);
  EXPECT_EQ(row.min, *std::min_element(values.begin(), values.end()));
  EXPECT_EQ(row.max, *std::max_element(values.begin(), values.end()));
  const estimator::BoxplotStatistics expected = boxplot_of(box);
  EXPECT_EQ(row.box.count, expected.count);
  EXPECT_EQ(row.box.q1, expected.q1);
  EXPECT_EQ(row.box.median, expected.median);
  EXPECT_EQ(row.box.q3, expected.q3);
  EXPECT_EQ(row.box.whisker_low, expected.whisker_low);
  EXPECT_EQ(row.box.whisker_high, expected.whisker_high);
  EXPECT_EQ(row.box.outliers, expected.outliers);
}

TEST(SummaryStore, SummarizesTheWindowsOfEveryPeriod) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  program.windows(0, 850);
  program.commit();
  for (std::size_t p = 0; p < 2; ++p) {
    const auto name = table().name[p];
    const auto short_rows = rows(s, name, 1), middle = rows(s, name, 2), longest = rows(s, name, 4);
    ASSERT_EQ(short_rows.size(), 9u);
    ASSERT_EQ(middle.size(), 5u);
    ASSERT_EQ(longest.size(), 3u);
    expect_summary(short_rows[3], p, 300, 400);
    expect_summary(short_rows[8], p, 800, 850);
    expect_summary(middle[1], p, 200, 400);
    expect_summary(longest[1], p, 400, 800);
    expect_summary(longest[2], p, 800, 850);
  }
}

TEST(SummaryStore, StoresNoNumbersForUnobservableParameters) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  window_estimate_t e = window(1);
  e.reason = {2, 2};
  e.value = {std::nan(""), std::nan("")};
  program.collector().add(e);
  program.commit();
  const Row row = rows(s, "kx_1_y1", 4).at(0);
  EXPECT_EQ(row.windows, 1);
  EXPECT_EQ(row.observable, 0);
  EXPECT_TRUE(std::isnan(row.mean) && std::isnan(row.min) && std::isnan(row.box.median));
}

/// Windows from before the tuning of the filters: in the current period, and in a stored one.
TEST(SummaryStore, PutsLateValuesIntoThePeriodsOfTheirWindows) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  for (std::int64_t i = 0; i < 150; ++i) {
    window_estimate_t e = window(i);
    e.reason = {1, 1};
    if (program.collector().ends_before(e)) program.commit();
    program.collector().add(e);
  }
  for (std::int64_t i = 0; i < 150; ++i) program.collector().add_late(window(i));
  program.windows(150, 200);
  program.commit();
  for (std::size_t p = 0; p < 2; ++p) {
    const auto name = table().name[p];
    expect_summary(rows(s, name, 1).at(0), p, 0, 100);
    expect_summary(rows(s, name, 1).at(1), p, 100, 200);
    expect_summary(rows(s, name, 2).at(0), p, 0, 200);
  }
  EXPECT_EQ(program.store().repeated(), 0);
}

TEST(SummaryStore, IgnoresLateValuesOfAMissingPeriod) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  program.windows(0, 50);
  program.collector().add_late(window(-150));
  program.commit();
  EXPECT_EQ(rows(s, "kx_1_y1", 1).size(), 1u);
}

TEST(SummaryStore, CountsRepeatedWindowsOnceAfterARestart) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  {
    Program program(s);
    program.windows(0, 550);
    program.commit();           // in the middle of a period
    program.windows(550, 580);  // lost when it is killed
  }
  Program again(s);
  again.windows(370, 1250);  // from an older state on
  again.commit();
  for (std::size_t p = 0; p < 2; ++p) {
    const auto name = table().name[p];
    expect_summary(rows(s, name, 1).at(4), p, 400, 500);
    expect_summary(rows(s, name, 1).at(5), p, 500, 600);
    expect_summary(rows(s, name, 2).at(2), p, 400, 600);
    expect_summary(rows(s, name, 4).at(1), p, 400, 800);
  }
  EXPECT_EQ(again.store().repeated(), 0);
}

TEST(SummaryStore, KeepsOldSummariesWhenTheClockGoesBack) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  program.windows(0, 2000);
  program.windows(150, 320);  // the sensors' clock was set back
  program.windows(2000, 2100);
  program.commit();
  expect_summary(rows(s, "kx_1_y1", 1).at(2), 0, 200, 300);
  expect_summary(rows(s, "kx_1_y1", 4).at(0), 0, 0, 400);
  expect_summary(rows(s, "kx_1_y1", 1).at(20), 0, 2000, 2100);
}

TEST(SummaryStore, AnotherProgramCannotChangeClosedPeriods) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  {
    Program program(s);
    program.windows(0, 2000);
    program.commit();
  }
  Program again(s);
  again.windows(0, 300);
  again.commit();
  EXPECT_EQ(again.store().repeated(), 3);
  expect_summary(rows(s, "kx_1_y1", 1).at(1), 0, 100, 200);
}

TEST(SummaryStore, RefusesASecondWriter) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  SummaryStore other(s);
  {
    Program program(s);
    EXPECT_EQ(other.open(), "another program writes this history");
  }
  EXPECT_EQ(other.open(), "");
}

TEST(SummaryStore, ForgetsValuesOfClosedPeriods) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  program.windows(0, 10'000);
  SqliteFile file;
  ASSERT_TRUE(file.open_to_read(summary_file(s.directory)));
  SqliteStatement count = file.prepare("SELECT count(*) FROM open_values");
  ASSERT_TRUE(count.row());
  EXPECT_LE(count.integer(0), 2 * 2 * 4);  // parameters, longest periods, shortest ones in each
}

TEST(SummaryStore, CountsChannelsByDifferencesOfStatus) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  const auto status = [](std::int64_t second, std::int64_t received, std::int64_t lost) {
    status_t m{};
    m.time_us = kStart_us + second * kSecond_us;
    m.channels = 1;
    m.name = {"base-x"};
    for (auto* column : {&m.late, &m.repaired, &m.rejected, &m.stuck, &m.clipped}) *column = {0};
    m.received = {received};
    m.lost = {lost};
    m.noise_mps2_per_rthz = {1e-4};
    return m;
  };
  program.collector().add(status(0, 5000, 7));  // counted before a restart
  program.collector().add(status(1, 5100, 7));
  program.collector().add(status(2, 5190, 17));
  program.collector().add(status(3, 40, 1));  // counters that restarted
  program.commit();
  SqliteFile file;
  ASSERT_TRUE(file.open_to_read(summary_file(s.directory)));
  SqliteStatement row =
      file.prepare("SELECT received, lost, noise FROM channel_summary WHERE period_s = 4");
  ASSERT_TRUE(row.row());
  EXPECT_EQ(row.integer(0), 230);
  EXPECT_EQ(row.integer(1), 11);
  EXPECT_EQ(row.number(2), 1e-4);
}

TEST(SummaryStore, StoresARepeatedEventOnce) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  SummaryBatch batch;
  event_t e{};
  e.kind = "gap";
  e.id = e.time_us = kStart_us;
  e.state = 1;
  e.std_error = std::nan("");
  e.message = "it's \"so\"";
  batch.events = {e, e};
  ASSERT_EQ(program.store().add(batch), "");
  e.state = 0;
  e.time_us += 5;
  batch.events.push_back(e);
  ASSERT_EQ(program.store().add(batch), "");
  SqliteFile file;
  ASSERT_TRUE(file.open_to_read(summary_file(s.directory)));
  SqliteStatement count = file.prepare("SELECT count(*), max(message) FROM event");
  ASSERT_TRUE(count.row());
  EXPECT_EQ(count.integer(0), 2);
  EXPECT_EQ(count.text(1), e.message);
}

TEST(SummaryStore, PrunesOnlyTheShortestPeriod) {
  const test::TemporaryDirectory directory;
  HistorySettings s = settings(directory);
  s.keep_summary_days = 1;
  Program program(s);
  program.windows(0, 1000);
  program.commit();
  const std::int64_t day_us = 86400 * kSecond_us;
  ASSERT_EQ(program.store().prune(kStart_us + day_us + 5 * kSecond_us), "");
  EXPECT_EQ(rows(s, "kx_1_y1", 1).size(), 5u);
  EXPECT_EQ(rows(s, "kx_1_y1", 2).size(), 5u);
}

TEST(SummaryHistory, AnEventBeforeTheFirstWindowPrunesNothing) {
  const test::TemporaryDirectory directory;
  const Config config = test::table_with_history(directory.path("h"));
  {
    Program program(*config.history);
    program.windows(0, 1000);
    program.commit();
  }
  {
    SummaryHistory history(config);
    event_t event{};
    event.kind = "history";
    history.message("FRAMEWATCH_EVENT", drivers::encoded(event));
    EXPECT_TRUE(
        test::comes_true([&] { return history.counters().commits > 0; }, std::chrono::seconds(5)));
  }
  EXPECT_EQ(rows(*config.history, "kx_1_y1", 1).size(), 10u);
}

TEST(SummaryStore, PrunesNothingWithoutATime) {
  const test::TemporaryDirectory directory;
  const HistorySettings s = settings(directory);
  Program program(s);
  program.windows(0, 1000);
  program.commit();
  for (const std::int64_t newest_us : {INT64_MIN, std::int64_t{0}, kSecond_us}) {
    ASSERT_EQ(program.store().prune(newest_us), "");
    EXPECT_EQ(rows(s, "kx_1_y1", 1).size(), 10u);
  }
}

}  // namespace history_summary_test
}  // namespace framewatch::daemon
