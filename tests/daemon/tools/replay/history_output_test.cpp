// SPDX-License-Identifier: MIT
#include <filesystem>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_history.h"
#include "daemon/tools/replay/history_output.h"
#include "daemon/tools/replay/replay_survey.h"
#include "tests/daemon/tools/replay/replay_fixture.h"
#include "tests/support/history_fixture.h"

namespace framewatch::daemon {
namespace history_output_test {

/// Returns every row of a table, without columns that depend on the time of the commit.
std::vector<std::string> rows_of(const std::string& database, const std::string& table) {
  SqliteFile file;
  EXPECT_TRUE(file.open_to_read(database));
  std::vector<std::string> columns, out;
  SqliteStatement names = file.prepare("SELECT name FROM pragma_table_info('" + table + "')");
  while (names.row())
    if (names.text(0) != "open" && names.text(0) != "first_us") columns.push_back(names.text(0));
  std::string list;
  for (const std::string& column : columns) list += (list.empty() ? "" : ", ") + column;
  SqliteStatement all = file.prepare("SELECT " + list + " FROM " + table + " ORDER BY 1, 2");
  while (all.row()) {
    std::string row;
    for (int c = 0; c < static_cast<int>(columns.size()); ++c) row += all.text(c) + " ";
    out.push_back(row);
  }
  EXPECT_FALSE(file.failed()) << table;
  return out;
}

class HistoryOutputTest : public test::ReplayFixture {
 protected:
  HistoryOutputTest() : config_(test::table_with_history(path("h"))) {}

  /// Returns the messages of the recorded test.
  void estimate(const MessageSink& sink) {
    Estimation estimation(config_, sink);
    ReplaySurvey survey(config_, false);
    survey.feed(estimation);
    survey.add(log());
    estimation.finish();
  }
  std::string written(const std::string& name, std::int64_t from_us = INT64_MIN,
                      std::int64_t to_us = INT64_MAX) {
    HistoryOutput out(config_);
    out.keep(from_us, to_us);
    EXPECT_TRUE(out.open(path(name))) << out.error();
    estimate([&](std::int64_t time_us, const std::string& channel,
                 const std::vector<std::uint8_t>& bytes) {
      EXPECT_TRUE(out.put(time_us, channel, bytes)) << out.error();
    });
    EXPECT_TRUE(out.close()) << out.error();
    return path(name);
  }

  Config config_;
};

TEST_F(HistoryOutputTest, HasTheRowsOfALiveHistory) {
  {
    SummaryHistory history(config_);
    estimate([&](std::int64_t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
      history.message(channel, bytes);
    });
  }
  const std::string live = summary_file(path("h")), written_at_once = written("x.sqlite");
  EXPECT_GT(rows_of(live, "summary").size(), 100u);
  for (const char* table :
       {"config", "parameter", "period", "summary", "channel", "channel_summary", "event"})
    EXPECT_EQ(rows_of(written_at_once, table), rows_of(live, table)) << table;
}

TEST_F(HistoryOutputTest, TheSameMessagesGiveTheSameBytes) {
  EXPECT_EQ(test::read_file(written("a.sqlite")), test::read_file(written("b.sqlite")));
  for (const std::string& name : own_.names()) EXPECT_TRUE(name.ends_with(".sqlite")) << name;
}

TEST_F(HistoryOutputTest, KeepsOnlyWholePeriodsOfItsTime) {
  const std::string whole = written("whole.sqlite");
  const auto all = rows_of(whole, "period");
  SqliteFile file;
  ASSERT_TRUE(file.open_to_read(whole));
  SqliteStatement starts = file.prepare("SELECT start_us FROM period WHERE period_s = 4");
  ASSERT_TRUE(starts.row() && starts.row());
  const std::int64_t from_us = starts.integer(0);
  const auto part = rows_of(written("part.sqlite", from_us, from_us + 4 * kSecond_us), "period");
  EXPECT_EQ(part.size(), 7u);  // of 1, 2 and 4 s
  for (const std::string& row : part)
    EXPECT_NE(std::find(all.begin(), all.end(), row), all.end()) << row;
}

TEST_F(HistoryOutputTest, CreatesItsFileOnlyWhenClosed) {
  {
    HistoryOutput out(config_);
    ASSERT_TRUE(out.open(path("x.sqlite")));
    EXPECT_FALSE(std::filesystem::exists(path("x.sqlite")));
    HistoryOutput another(config_);
    EXPECT_FALSE(another.open(path("x.sqlite")));
    EXPECT_NE(another.error().find("is being written"), std::string::npos) << another.error();
  }
  EXPECT_TRUE(own_.names().empty());
  HistoryOutput nowhere(config_);
  EXPECT_FALSE(nowhere.open(path("none/x.sqlite")));
}

TEST_F(HistoryOutputTest, ReplayWritesItAndRefusesBadOptions) {
  const std::string out = path("est.sqlite");
  ASSERT_EQ(test::replay_of({log()}, out).exit_code, 0);
  EXPECT_GT(rows_of(out, "summary").size(), 20u);
  ReplayArguments boxes{test::table_config(), {log()}, out, false, false, false};
  boxes.boxplot = true;
  ReplayArguments goes_on{test::table_config(), {log()}, out, false, false, false};
  goes_on.load_state = path("state");
  for (const ReplayArguments& bad : {boxes, goes_on}) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(replay(bad), 2);
    EXPECT_NE(testing::internal::GetCapturedStderr().find(".sqlite"), std::string::npos);
  }
}

}  // namespace history_output_test
}  // namespace framewatch::daemon
