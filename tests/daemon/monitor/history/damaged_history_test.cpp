// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <framewatch/event_t.hpp>
#include <framewatch/history_status_t.hpp>

#include <gtest/gtest.h>

#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/history/history_command.h"
#include "daemon/monitor/history/summary_query.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/lcm_provider.h"
#include "tests/daemon/monitor/history/summary_program.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace damaged_history_test {

namespace fs = std::filesystem;
using test::comes_true;

// Limits.
constexpr std::chrono::seconds kSoon{30};  // for actions that take a second

event_t gap(std::int64_t id) {
  event_t e{};
  e.kind = "gap";
  e.id = id;
  e.state = event_state::raised;
  e.time_us = e.since_us = kStart_us + id;
  e.place = "F1-Y1";
  e.message = "they differ";
  return e;
}

/// A history of some seconds with an event, number 1.
class DamagedHistory : public testing::Test {
 protected:
  DamagedHistory() : config_(test::table_with_history(directory_.path("h"))) {
    Program program(*config_.history);
    program.windows(0, 2000);
    program.commit();
    SummaryBatch batch;
    batch.events = {gap(1)};
    EXPECT_EQ(program.store().add(batch), "");
  }
  std::string folder() const { return config_.history->directory; }
  std::string database() const { return summary_file(folder()); }

  /// Overwrites the first page of a table.
  void damage(const std::string& table) const {
    std::int64_t page = 0, size = 0;
    {
      SqliteFile file;
      EXPECT_TRUE(file.open(database()));
      EXPECT_TRUE(file.execute("PRAGMA wal_checkpoint(TRUNCATE)"));
      SqliteStatement root = file.prepare("SELECT rootpage FROM sqlite_master WHERE name = ?");
      root.bind(1, table);
      EXPECT_TRUE(root.row());
      page = root.integer(0);
      SqliteStatement bytes = file.prepare("PRAGMA page_size");
      EXPECT_TRUE(bytes.row());
      size = bytes.integer(0);
    }
    std::fstream file(database(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp((page - 1) * size);
    file << std::string(static_cast<std::size_t>(size), '\xa5');
  }
  void cut_in_half() const { fs::resize_file(database(), fs::file_size(database()) / 2 + 200); }

  std::vector<std::string> set_aside() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder()))
      if (const std::string name = entry.path().filename();
          name.starts_with("history.sqlite.corrupt-") && !name.ends_with("-wal") &&
          !name.ends_with("-shm"))
        out.push_back(entry.path());
    return out;
  }
  std::vector<std::int64_t> stored_events() const {
    SummaryQuery query;
    std::vector<std::int64_t> out;
    if (!query.open(folder()).empty()) return out;
    for (const event_t& e : query.events(INT64_MIN / 4, INT64_MAX / 4, 100)) out.push_back(e.id);
    return query.problem().empty() ? out : std::vector<std::int64_t>();
  }
  /// Expects a running history to store the events and windows that it gets.
  void expect_a_new_one(std::vector<std::int64_t> events) const {
    {
      SummaryHistory history(config_);
      history.message("FRAMEWATCH_EVENT", drivers::encoded(gap(7)));
      events.push_back(7);
      EXPECT_TRUE(comes_true([&] { return stored_events() == events; }, kSoon));
      const SummaryHistory::Counters counters = history.counters();
      EXPECT_EQ(counters.trouble, "");
      EXPECT_EQ(counters.dropped, 0);
      EXPECT_EQ(counters.set_aside.count, 1);
      ASSERT_EQ(set_aside().size(), 1u);
      EXPECT_EQ(counters.set_aside.path, set_aside().front());
    }
    EXPECT_EQ(stored_events(), events);
  }

  const test::TemporaryDirectory directory_;
  Config config_;
};

TEST_F(DamagedHistory, SetsATruncatedDatabaseAside) {
  cut_in_half();
  const std::string half = test::read_file(database());
  expect_a_new_one({});
  EXPECT_EQ(test::read_file(set_aside().at(0)), half);
}

TEST_F(DamagedHistory, SetsAFileAsideThatIsNotADatabase) {
  test::write_file(database(), std::string(10'000, 'n'));
  fs::remove(database() + "-wal");
  expect_a_new_one({});
}

TEST_F(DamagedHistory, KeepsReadableEvents) {
  damage("period");
  expect_a_new_one({1});
}

/// SQL of a foreign database never runs in the daemon.
TEST_F(DamagedHistory, SetsADatabaseWithForeignPartsAside) {
  for (const std::string sql :
       {"CREATE TRIGGER a AFTER INSERT ON event BEGIN DELETE FROM event; END",
        "ALTER TABLE period RENAME TO p;"
        "CREATE VIEW period AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c)"
        " SELECT 60 AS period_s, x AS start_us, 1 AS windows, x AS last_us, 1 AS open FROM c",
        "CREATE TABLE other (x)", "DROP INDEX event_time"}) {
    fs::remove_all(folder());
    {
      SummaryStore store(*config_.history);
      ASSERT_EQ(store.open(), "");
      SqliteFile file;
      ASSERT_TRUE(file.open(database()));
      ASSERT_TRUE(file.execute(sql)) << file.error();
    }
    SummaryQuery query;
    EXPECT_NE(query.open(folder()).find("another program's"), std::string::npos) << sql;
    expect_a_new_one({});
  }
}

TEST_F(DamagedHistory, BeginsAnewWhenTheDatabaseIsMovedRemovedOrReplaced) {
  const std::string copy = directory_.path("copy"), moved = directory_.path("moved");
  fs::copy_file(database(), copy);
  SummaryHistory history(config_);
  std::int64_t count = 0, id = 10;
  const auto expect_another = [&](const std::string& how) {
    ++count;
    EXPECT_TRUE(comes_true([&] { return history.counters().set_aside.count == count; }, kSoon))
        << how;
    history.message("FRAMEWATCH_EVENT", drivers::encoded(gap(++id)));
    EXPECT_TRUE(comes_true(
        [&] {
          const std::vector<std::int64_t> events = stored_events();
          return !events.empty() && events.back() == id;
        },
        kSoon))
        << how;
    EXPECT_NE(history.counters().set_aside.reason.find("removed or replaced"), std::string::npos);
    EXPECT_EQ(history.counters().trouble, "") << how;
  };
  history.message("FRAMEWATCH_EVENT", drivers::encoded(gap(id)));
  ASSERT_TRUE(comes_true([&] { return history.counters().commits > 0; }, kSoon));
  fs::rename(database(), moved);
  expect_another("moved");
  EXPECT_EQ(history.counters().set_aside.path, "");
  for (const char* ending : {"", "-wal", "-shm"}) fs::remove(database() + ending);
  expect_another("removed");
  EXPECT_EQ(history.counters().set_aside.path, "");
  fs::rename(copy, database());
  expect_another("replaced");
  fs::remove_all(folder());
  expect_another("removed with its folder");
}

TEST_F(DamagedHistory, LeavesOutImpossiblePeriods) {
  std::vector<SummaryPeriods> sound;
  std::optional<std::int64_t> newest_us;
  for (const bool damaged : {false, true}) {
    if (damaged) {
      SqliteFile file;
      ASSERT_TRUE(file.open(database()));
      for (const std::string row :
           {"0, 5, 1, 6", "-60, 5, 1, 6", "9223372036854775807, 5, 1, 6",
            "1, 9223372036854775807, 1, 6", "1, 5, 1, -9223372036854775807 - 1"})
        ASSERT_TRUE(file.execute("INSERT INTO period VALUES (" + row + ", 0)")) << row;
    }
    SummaryQuery query;
    ASSERT_EQ(query.open(folder()), "");
    if (damaged) {
      ASSERT_EQ(query.periods().size(), sound.size());
      EXPECT_EQ(query.periods().front().count, sound.front().count);
      EXPECT_EQ(query.newest_us(), newest_us);
    }
    sound = query.periods();
    newest_us = query.newest_us();
  }
}

TEST_F(DamagedHistory, SetsADatabaseAsideWhenDamageShowsLater) {
  damage("event");
  expect_a_new_one({});
}

TEST_F(DamagedHistory, KeepsAnIntactLockedOrNewerDatabase) {
  {
    SqliteFile file;
    ASSERT_TRUE(file.open(database()));
    ASSERT_TRUE(file.execute("PRAGMA user_version = 77"));
  }
  SummaryHistory history(config_);
  EXPECT_TRUE(comes_true(
      [&] { return history.counters().trouble.find("newer") != std::string::npos; }, kSoon));
  EXPECT_EQ(history.counters().set_aside.count, 0);
  EXPECT_TRUE(set_aside().empty());
}

TEST(SetAsideDatabase, ReportsADatabaseThatCannotBeSetAside) {
  SetAside aside;
  set_aside_database("/sys/kernel/notes", 0, "malformed", aside);
  EXPECT_NE(aside.problem.find("cannot be set aside"), std::string::npos) << aside.problem;
  EXPECT_EQ(aside.count, 0);
}

TEST_F(DamagedHistory, TheCommandReportsDamageAndWritesNothing) {
  for (const bool half : {true, false}) {
    if (half)
      damage("summary");
    else
      cut_in_half();
    for (const std::string ending : {".csv", ".csv.gz", ".mat"}) {
      HistoryArguments a;
      a.place = folder();
      a.out = directory_.path("out" + ending);
      testing::internal::CaptureStderr();
      EXPECT_EQ(history(a), 2);
      const std::string said = testing::internal::GetCapturedStderr();
      EXPECT_NE(said.find(database() + ": the database is corrupt"), std::string::npos) << said;
      EXPECT_FALSE(fs::exists(a.out)) << "not half of them";
      EXPECT_FALSE(fs::exists(a.out + ".partial"));
    }
  }
}

/// service_t and `framewatch status` show what raised() has.
TEST_F(DamagedHistory, RaisesTheAlarmUntilTheProgramEnds) {
  cut_in_half();
  drivers::LcmProvider lcm("memq://");
  HistoryReport report(config_, lcm);
  std::int64_t now_us = kStart_us;
  const auto raised = [&] {
    (void)report.update(now_us += 1'000'000);
    return report.raised().find("history", "database") != nullptr;
  };
  EXPECT_TRUE(comes_true(raised, kSoon));
  for (int minute = 0; minute < 60; ++minute) {
    now_us += 60'000'000;
    EXPECT_TRUE(raised());
  }
}

TEST(HistoryMonitor, KeepsAnAlarmForADatabaseThatWasSetAside) {
  HistoryMonitor monitor;
  history_status_t s{};
  SetAside aside;
  EXPECT_TRUE(monitor.update(kStart_us, s, aside).empty());
  aside = {1, "/h/history.sqlite.corrupt-1", "malformed", ""};
  const auto raised = monitor.update(kStart_us, s, aside);
  ASSERT_EQ(raised.size(), 1u);
  EXPECT_EQ(raised[0].kind, "history");
  EXPECT_EQ(raised[0].place, "database");
  EXPECT_EQ(raised[0].state, event_state::raised);
  EXPECT_EQ(raised[0].severity, severity::alarm);
  EXPECT_EQ(raised[0].time_us, kStart_us) << "the host's, before a sample has come";
  EXPECT_EQ(raised[0].message,
            "the database is unusable: malformed: renamed it /h/history.sqlite.corrupt-1 and "
            "started a new one. Check the disk, and who else writes there");
  EXPECT_TRUE(monitor.update(kStart_us + 60'000'000, s, aside).empty());
  aside = {2, "", "it was removed", ""};
  const auto changed = monitor.update(kStart_us + 61'000'000, s, aside);
  ASSERT_EQ(changed.size(), 1u);
  EXPECT_EQ(changed[0].id, raised[0].id);
  EXPECT_EQ(changed[0].state, event_state::changed);
  EXPECT_EQ(changed[0].value, 2);
  EXPECT_NE(changed[0].message.find(": it was removed: started a new one."), std::string::npos);
}

}  // namespace damaged_history_test
}  // namespace framewatch::daemon
