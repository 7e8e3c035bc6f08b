#include "daemon/base/sqlite_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace sqlite_file_test {

TEST(SqliteFile, AStatementThatFailsFailsTheTransaction) {
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
    return true;  // whoever forgets to look is not believed
  }));
  EXPECT_NE(file.error(), "");
  SqliteStatement count = file.prepare("SELECT count(*) FROM a");
  ASSERT_TRUE(count.row());
  EXPECT_EQ(count.integer(0), 0);
}

TEST(SqliteFile, AStatementThatTheSchemaHasNotFailsWhateverIsAskedOfIt) {
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

}  // namespace sqlite_file_test
}  // namespace framewatch::daemon
