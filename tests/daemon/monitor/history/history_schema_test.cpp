// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_schema.h"

#include <span>
#include <string>

#include <gtest/gtest.h>

#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_store.h"
#include "tests/daemon/monitor/history/summary_program.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_schema_test {

constexpr const char* kTwoSteps[] = {"CREATE TABLE a (x INTEGER)",
                                     "ALTER TABLE a ADD COLUMN y INTEGER NOT NULL DEFAULT 7"};

TEST(Schema, UpgradesAnOlderDatabaseWithItsContents) {
  const test::TemporaryDirectory directory;
  SqliteFile file;
  ASSERT_TRUE(file.open(directory.path("db")));
  ASSERT_EQ(upgrade(file, std::span(kTwoSteps).first(1)), "");
  ASSERT_TRUE(file.execute("INSERT INTO a VALUES (42)"));
  EXPECT_NE(version_problem(file, kTwoSteps), "");
  ASSERT_EQ(upgrade(file, kTwoSteps), "");
  ASSERT_EQ(upgrade(file, kTwoSteps), "");
  EXPECT_EQ(version_problem(file, kTwoSteps), "");
  SqliteStatement row = file.prepare("SELECT x, y FROM a");
  ASSERT_TRUE(row.row());
  EXPECT_EQ(row.integer(0), 42);
  EXPECT_EQ(row.integer(1), 7);
}

TEST(Schema, AFailedUpgradeLeavesTheDatabaseUnchanged) {
  const test::TemporaryDirectory directory;
  SqliteFile file;
  ASSERT_TRUE(file.open(directory.path("db")));
  ASSERT_EQ(upgrade(file, std::span(kTwoSteps).first(1)), "");
  constexpr const char* kBad[] = {kTwoSteps[0], "CREATE TABLE b (x); CREATE TABLE a (x)"};
  EXPECT_NE(upgrade(file, kBad).find("schema 2"), std::string::npos);
  SqliteStatement b = file.prepare("SELECT count(*) FROM sqlite_master WHERE name = 'b'");
  ASSERT_TRUE(b.row());
  EXPECT_EQ(b.integer(0), 0);
  EXPECT_EQ(version_problem(file, std::span(kTwoSteps).first(1)), "");
}

TEST(Schema, RefusesANewerDatabaseUnchanged) {
  const test::TemporaryDirectory directory;
  HistorySettings s;
  s.directory = directory.path("h");
  {
    SummaryStore store(s);
    ASSERT_EQ(store.open(), "");
  }
  {
    SqliteFile file;
    ASSERT_TRUE(file.open(summary_file(s.directory)));
    ASSERT_TRUE(file.execute("PRAGMA user_version = 99"));
  }
  SummaryStore store(s);
  EXPECT_NE(store.open().find("a newer framewatch"), std::string::npos);
}

}  // namespace history_schema_test
}  // namespace framewatch::daemon
