// SPDX-License-Identifier: MIT
#include "drivers/records/record_csv_writer.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace record_csv_writer_test {

constexpr double kLost = std::numeric_limits<double>::quiet_NaN();

void write_two_rows(RecordCsvWriter& writer, const std::string& path) {
  ASSERT_TRUE(writer.open(path, {"F1-y1", "F0-x"})) << writer.error();
  ASSERT_TRUE(writer.write(0, {0.1, -2}));
  ASSERT_TRUE(writer.write(0.01, {kLost, 1.0 / 3}));
}

TEST(RecordCsvWriter, WritesHeaderValuesAndHoles) {
  const test::TemporaryDirectory directory;
  RecordCsvWriter writer;
  write_two_rows(writer, directory.path("rec.csv"));
  ASSERT_TRUE(writer.close()) << writer.error();
  EXPECT_EQ(test::read_file(directory.path("rec.csv")),
            "time_s,F1-y1,F0-x\n0,0.1,-2\n0.01,,0.3333333333333333\n");
  EXPECT_EQ(directory.names(), std::vector<std::string>{"rec.csv"});
}

TEST(RecordCsvWriter, CompressesToTheSameBytesEveryTime) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"a.csv.gz", "b.csv.gz"}) {
    RecordCsvWriter writer;
    write_two_rows(writer, directory.path(name));
    ASSERT_TRUE(writer.close());
  }
  const std::string a = test::read_file(directory.path("a.csv.gz"));
  EXPECT_EQ(a.substr(0, 2), "\x1f\x8b");
  EXPECT_EQ(a, test::read_file(directory.path("b.csv.gz")));
}

TEST(RecordCsvWriter, LeavesNoFileWithoutClose) {
  const test::TemporaryDirectory directory;
  {
    RecordCsvWriter writer;
    write_two_rows(writer, directory.path("rec.csv"));
  }
  EXPECT_TRUE(directory.names().empty());
}

TEST(RecordCsvWriter, ReportsWhyItCannotWrite) {
  const test::TemporaryDirectory directory;
  RecordCsvWriter nowhere, comma;
  EXPECT_FALSE(nowhere.open(directory.path("no/such/rec.csv"), {"a"}));
  EXPECT_EQ(nowhere.error(), "No such file or directory");
  EXPECT_FALSE(comma.open(directory.path("rec.csv"), {"a,b"}));
  EXPECT_NE(comma.error().find("a,b"), std::string::npos);
  for (const char* name : {"a\nb", "a\rb", "a\x1b[31m", "a\x7f", "a\"b"}) {
    RecordCsvWriter writer;
    EXPECT_FALSE(writer.open(directory.path("rec.csv"), {name}));
    EXPECT_EQ(writer.error().find_first_of("\n\r\x1b\x7f"), std::string::npos);
  }
  EXPECT_TRUE(directory.names().empty());
}

}  // namespace record_csv_writer_test
}  // namespace framewatch::drivers
