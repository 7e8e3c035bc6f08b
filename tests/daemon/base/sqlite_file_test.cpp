// SPDX-License-Identifier: MIT
#include "daemon/base/sqlite_file.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace sqlite_file_test {

TEST(SqliteFile, AFailedStatementFailsTheTransaction) {
  const test::TemporaryDirectory directory;
  SqliteFile file;
  ASSERT_TRUE(file.open(directory.path("db")));
  ASSERT_TRUE(file.execute("CREATE TABLE a (x INTEGER PRIMARY KEY)"));
  EXPECT_FALSE(file.transaction([&] {
    SqliteStatement put = file.prepare("INSERT INTO a VALUES (1)");
    EXPECT_TRUE(put.run());
    EXPECT_FALSE(put.run());
    SqliteStatement other = file.prepare("INSERT INTO a VALUES (2)");
    EXPECT_FALSE(other.run());
    return true;  // commit fails if the error was not read
  }));
  EXPECT_NE(file.error(), "");
  SqliteStatement count = file.prepare("SELECT count(*) FROM a");
  ASSERT_TRUE(count.row());
  EXPECT_EQ(count.integer(0), 0);
}

TEST(SqliteFile, AnInvalidStatementFailsInEveryCall) {
  const test::TemporaryDirectory directory;
  SqliteFile file;
  ASSERT_TRUE(file.open(directory.path("db")));
  EXPECT_FALSE(file.transaction([&] {
    SqliteStatement find = file.prepare("SELECT x FROM not_there WHERE x = ?");
    find.bind(1, std::int64_t{1});
    EXPECT_FALSE(find.row());
    EXPECT_TRUE(find.null(0));
    EXPECT_EQ(find.text(0), "");
    EXPECT_TRUE(find.numbers(0).empty());
    find.again();
    return true;
  }));
  EXPECT_NE(file.error().find("not_there"), std::string::npos) << file.error();
}

constexpr const char* kEndless =
    "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT sum(x) FROM c";

TEST(SqliteFile, InterruptsAStatementWithoutEnd) {
  constexpr double kLongest_s = 0.2;
  const test::TemporaryDirectory directory;
  SqliteFile file(kLongest_s);
  ASSERT_TRUE(file.open(directory.path("db")));
  EXPECT_FALSE(file.execute(kEndless));
  EXPECT_NE(file.error().find("interrupted"), std::string::npos) << file.error();
  SqliteStatement endless = file.prepare(kEndless);
  EXPECT_FALSE(endless.row());
  EXPECT_TRUE(file.failed());
  EXPECT_FALSE(file.corrupt());
}

TEST(SqliteFile, RunsNoSqlOfTheFile) {
  const test::TemporaryDirectory directory;
  SqliteFile file;
  ASSERT_TRUE(file.open(directory.path("db")));
  ASSERT_TRUE(
      file.execute("CREATE TABLE a (x INTEGER);"
                   "CREATE TRIGGER t AFTER INSERT ON a BEGIN DELETE FROM a; END;"
                   "CREATE VIEW v AS SELECT x FROM a;"));
  ASSERT_TRUE(file.execute("INSERT INTO a VALUES (1)"));
  {
    SqliteStatement count = file.prepare("SELECT count(*) FROM a");
    ASSERT_TRUE(count.row());
    EXPECT_EQ(count.integer(0), 1);
  }
  SqliteStatement view = file.prepare("SELECT x FROM v");
  EXPECT_FALSE(view.row());
}

TEST(SqliteFile, KnowsWhetherItsPathStillNamesIt) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("db"), elsewhere = directory.path("elsewhere");
  SqliteFile file;
  ASSERT_TRUE(file.open(path));
  EXPECT_TRUE(file.in_place());
  std::filesystem::rename(path, elsewhere);
  EXPECT_FALSE(file.in_place());
  std::filesystem::copy_file(elsewhere, path);
  EXPECT_FALSE(file.in_place());
  std::filesystem::rename(elsewhere, path);
  EXPECT_TRUE(file.in_place());
}

}  // namespace sqlite_file_test

namespace damaged_database_test {

using Names = std::vector<std::string>;
constexpr std::int64_t kNow_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z

TEST(DamagedDatabase, IsSetAsideWithItsLog) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"h.sqlite", "h.sqlite-wal", "h.sqlite-shm"})
    test::write_file(directory.path(name), name);
  SetAside aside;
  set_aside_database(directory.path("h.sqlite"), kNow_us, "malformed", aside);
  EXPECT_EQ(aside.problem, "");
  EXPECT_EQ(aside.count, 1);
  EXPECT_EQ(aside.path, directory.path("h.sqlite.corrupt-20261122T000000Z"));
  EXPECT_EQ(aside.reason, "malformed");
  EXPECT_EQ(directory.names(),
            (Names{"h.sqlite.corrupt-20261122T000000Z", "h.sqlite.corrupt-20261122T000000Z-shm",
                   "h.sqlite.corrupt-20261122T000000Z-wal"}));
  EXPECT_EQ(test::read_file(aside.path), "h.sqlite");
}

TEST(DamagedDatabase, KeepsTheThreeLargest) {
  const test::TemporaryDirectory directory;
  SetAside aside;
  for (const int bytes : {50, 10, 40, 20, 30}) {
    test::write_file(directory.path("h.sqlite"), std::string(static_cast<std::size_t>(bytes), 'x'));
    test::write_file(directory.path("h.sqlite-wal"), "log");
    set_aside_database(directory.path("h.sqlite"), kNow_us, "malformed", aside);
    ASSERT_EQ(aside.problem, "");
  }
  EXPECT_EQ(aside.count, 5);
  std::vector<std::int64_t> kept;
  for (const std::string& name : directory.names())
    if (!name.ends_with("-wal"))
      kept.push_back(static_cast<std::int64_t>(std::filesystem::file_size(directory.path(name))));
  std::sort(kept.begin(), kept.end());
  EXPECT_EQ(kept, (std::vector<std::int64_t>{30, 40, 50}));
  EXPECT_EQ(directory.names().size(), 6u) << "their logs with them";
}

}  // namespace damaged_database_test

}  // namespace framewatch::daemon
