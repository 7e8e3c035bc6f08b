// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_store.h"
#include "estimator/identify/estimate/estimate.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

// Programs that write summaries of known windows into a history, and the contents of its database.
namespace framewatch::daemon {

inline constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z
inline constexpr std::int64_t kHop_us = 10'000;

inline parameter_table_t table() {
  parameter_table_t t{};
  t.structure = "table";
  t.config_sha256 = "00ff";
  t.version = "0.1.0";
  t.rate_hz = 100;
  t.window_rows = 100;
  t.parameters = 2;
  t.name = {"kx_1_y1", "cx_1_y1"};
  t.unit = {"N/m", "N*s/m"};
  t.kind = {0, 2};
  t.story = {1, 1};
  return t;
}

/// Makes window number i; the second parameter is observable in every third.
inline window_estimate_t window(std::int64_t i) {
  window_estimate_t e{};
  e.window_end_us = kStart_us + i * kHop_us;
  const auto x = static_cast<double>(i);
  e.value = {34e3 + 100 * std::sin(x), 50 + std::cos(0.1 * x)};
  e.std_error = {10 + std::sin(0.3 * x), 0.5};
  e.reason = {0, i % 3 == 0 ? 0 : 2};
  return e;
}

struct Row {
  std::int64_t observable;
  double mean, std_error, min, max;
  estimator::BoxplotStatistics box;
  std::int64_t windows;
};

/// Returns the summaries of a parameter in the database.
inline std::vector<Row> rows(const HistorySettings& settings, const std::string& parameter,
                             std::int64_t period_s) {
  SqliteFile file;
  EXPECT_TRUE(file.open_to_read(summary_file(settings.directory)));
  SqliteStatement s = file.prepare(
      "SELECT observable, mean, std_error, min, max, q1, median, q3, whisker_low, whisker_high,"
      " outliers, boxed, windows FROM summary JOIN parameter ON parameter.id = parameter"
      " JOIN period USING (period_s, start_us)"
      " WHERE name = ? AND period_s = ? ORDER BY start_us");
  s.bind(1, parameter).bind(2, period_s);
  std::vector<Row> out;
  while (s.row())
    out.push_back({s.integer(0),
                   s.number(1),
                   s.number(2),
                   s.number(3),
                   s.number(4),
                   {s.number(5), s.number(6), s.number(7), s.number(8), s.number(9),
                    static_cast<int>(s.integer(10)), static_cast<int>(s.integer(11))},
                   s.integer(12)});
  EXPECT_FALSE(file.failed());
  return out;
}

/// A program that collects and commits. Its destruction is like kill -9: it loses what it has not
/// committed.
class Program {
 public:
  explicit Program(const HistorySettings& settings)
      : store_(settings), collector_(kSecond_us * settings.summary_s.front()) {
    EXPECT_EQ(store_.open(), "");
    for (const auto& [start_us, last_us] : store_.open_periods())
      collector_.taken(start_us, last_us);
    collector_.add(table());
  }
  void windows(std::int64_t from, std::int64_t to) {
    for (std::int64_t i = from; i < to; ++i) {
      const window_estimate_t e = window(i);
      if (collector_.ends_before(e)) commit();
      collector_.add(e);
    }
  }
  void commit() {
    SummaryBatch batch;
    batch.parameters = table();
    batch.channels = collector_.channels();
    batch.periods = collector_.take_late();
    if (!collector_.empty()) batch.periods.push_back(collector_.take());
    EXPECT_EQ(store_.add(batch), "");
  }
  SummaryStore& store() { return store_; }
  PeriodCollector& collector() { return collector_; }

 private:
  SummaryStore store_;
  PeriodCollector collector_;
};

inline HistorySettings settings(const test::TemporaryDirectory& directory) {
  return *test::table_with_history(directory.path("h")).history;  // 1, 2 and 4 s
}

}  // namespace framewatch::daemon
