// SPDX-License-Identifier: MIT
// Tables with a header, as spreadsheets and loggers write them.
#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/formats/record_file.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace table_test {

constexpr double kG = 9.80665;

class Table : public testing::Test {
 protected:
  std::optional<Record> read(const std::string& text) {
    test::write_file(path_, text);
    problems_.clear();
    auto record = read_record(path_, options_, problems_);
    EXPECT_EQ(record.has_value(), problems_.empty());
    options_ = {};
    return record;
  }

  /// Expects times 0 and 0.01 s and values 0.5 and -1 in channel "a".
  void expect_read(const std::string& text, double unit_mps2 = 1) {
    SCOPED_TRACE(text);
    const auto record = read(text);
    for (const Problem& p : problems_) ADD_FAILURE() << p.where << ": " << p.message;
    if (!record) return;
    EXPECT_EQ(record->names, std::vector<std::string>{"a"});
    ASSERT_EQ(record->time_s.size(), 2U);
    EXPECT_NEAR(record->time_s[1] - record->time_s[0], 0.01, 1e-6);
    EXPECT_DOUBLE_EQ(record->accel_mps2[0][0], 0.5 * unit_mps2);
    EXPECT_DOUBLE_EQ(record->accel_mps2[0][1], -1 * unit_mps2);
  }

  /// Expects a problem at this line (0: the file) that contains each of these parts.
  void expect_refused(const std::string& text, int line, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    EXPECT_FALSE(read(text));
    const std::string where = line > 0 ? fmt::format("{}:{}", path_, line) : path_;
    const bool found = std::any_of(problems_.begin(), problems_.end(), [&](const Problem& p) {
      return p.where == where && std::all_of(parts.begin(), parts.end(), [&](const auto& part) {
               return p.message.find(part) != std::string::npos;
             });
    });
    EXPECT_TRUE(found) << "expected at " << where << ": " << parts.at(0);
    for (const Problem& p : problems_)
      if (!found) ADD_FAILURE() << p.where << ": " << p.message;
  }

  std::string notes(const Record& record) const {
    std::string all;
    for (const std::string& note : record.notes) all += note + "\n";
    return all;
  }

  test::TemporaryDirectory directory_;
  std::string path_ = directory_.path("rec.csv");
  RecordOptions options_;
  std::vector<Problem> problems_;
};

TEST_F(Table, ReadsTheSeparatorsAndQuotesOfSpreadsheets) {
  for (const char* text : {
           "Time,a [m/s2]\n0,0.5\n0.01,-1\n",
           "Time;a [m/s^2]\r\n0;0.5\r\n0.01;-1\r\n",
           "t\ta [m/s\xC2\xB2]\n0\t0.5\n0.01\t-1\n",
           "TIME [s]; a (m/s\xB2)\n0;0,5\n0,01;-1\n",
           "\xEF\xBB\xBF\"Time (s)\";\"a [m/s^2]\"\n\"0\";\"0,5\"\n\"0,01\";\"-1\"\n",
           "\"time [ms]\",\"a [m/s2]\"\n\"0\",\"0,5\"\n\"10\",\"-1,0\"\n",
           "# logger 7\n% more\n// and more\nTime;a [m/s2];\n0;0,5;\n\n0,01;-1;\n",
           "time_ms,a [m/s/s]\n0,0.5\n10,-1\n",
           "Time / s;a [m s^-2]\n0;0.5\n0.01;-1\n",
           "Time [\xC2\xB5s]\ta [m/s2]\n0\t0.5\n10000\t-1\n",
           "Time;a\n[s];[m/s^2]\n0;0,5\n0,01;-1\n",
           "t a[m/s2]\n0 0.5\n 0.01  -1\n",
           "Logger 7\nStarted 2026-11-21\nTime;a [m/s2]\n0;0.5\n0.01;-1\n",
       })
    expect_read(text);
  expect_read("Time;a [g]\n0;0,5\n0,01;-1\n", kG);
  expect_read("Time;a (mg)\n0;0,5\n0,01;-1\n", kG / 1000);
  expect_read("Time;a [Gal]\n0;0,5\n0,01;-1\n", 0.01);
  expect_read("Time;a [cm/s^2]\n0;0,5\n0,01;-1\n", 0.01);
  expect_read("Time;a [mm/s2]\n0;0,5\n0,01;-1\n", 0.001);
}

TEST_F(Table, KeepsOrderAndMissingValuesAndReportsLeftOutColumns) {
  expect_refused("Time,\"b, north [g]\"\n0,1\n0.01,1\n", 1, {"b, north", "must not contain"});
  options_.columns = {"c", "a"};
  const auto two = read(
      "Logger 7\nc [g];Time [s];Temp [degC];a [m/s2]\n1;0;20;NA\n2;0,01;20;#N/A\n3;0,02;20;1,5\n");
  ASSERT_TRUE(two);
  EXPECT_EQ(two->names, (std::vector<std::string>{"c", "a"}));
  EXPECT_DOUBLE_EQ(two->accel_mps2[0][2], 3 * kG);
  EXPECT_TRUE(std::isnan(two->accel_mps2[1][1]));
  EXPECT_EQ(two->accel_mps2[1][2], 1.5);
  EXPECT_NE(notes(*two).find("Temp [degC]\": not one of --columns, left out"), std::string::npos);
  EXPECT_NE(notes(*two).find("1 lines of text above the header"), std::string::npos);
  EXPECT_NE(notes(*two).find("a: 2 of 3 samples have no value"), std::string::npos);
}

TEST_F(Table, AsksForAMissingUnit) {
  expect_refused("Time,a\n0,1\n0.01,2\n", 1, {"\"a\"", "--unit"});
  options_.unit_mps2 = kG;
  expect_read("Time,a\n0,0.5\n0.01,-1\n", kG);
  options_.unit_mps2 = kG;
  expect_refused("Time,a [g]\n0,1\n0.01,2\n", 1, {"--unit does not apply"});
  expect_refused("Time [s],a [mV]\n0,1\n0.01,2\n", 1, {"\"a\"", "mV", "--columns"});
  expect_refused("Time [h],a [g]\n0,1\n0.01,2\n", 1, {"\"h\"", "s, ms, us or ns"});
}

TEST_F(Table, AsksForTheTimeColumnIfItIsNotUnique) {
  expect_refused("Date;Time;a [g]\n0;0;1\n1;1;1\n", 1, {"\"Date\", \"Time\"", "--time"});
  expect_refused("Time 1;a [g];Time;b [g];t\n0;1;0;1;0\n1;1;1;1;1\n", 1, {"\"Time\", \"t\""});
  options_.time_column = "t";
  options_.columns = {"a"};
  expect_read("Time;t;a [m/s2]\n7;0;0,5\n7;0,01;-1\n");
  options_.time_column = "clock";
  expect_read("clock;a [m/s2]\n0;0,5\n0,01;-1\n");
  options_.time_column = "no";
  expect_refused("Time;a [g]\n0;1\n1;1\n", 1, {"--time", "no such column"});
  expect_refused("clock;a [g]\n0;1\n1;1\n", 1, {"--time", "--step"});
  options_.step_s = 0.01;
  const auto record = read("a [m/s2],b [m/s2]\n1,2\n3,4\n5,6\n");
  ASSERT_TRUE(record);
  EXPECT_EQ(record->names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(record->accel_mps2[1], (std::vector<double>{2, 4, 6}));
  EXPECT_DOUBLE_EQ(record->rate_hz, 100);
}

TEST_F(Table, AsksWhetherACommaIsDecimal) {
  expect_refused("Time;a [g]\n0;1,234\n1;2,345\n", 2, {"1,234", "--decimal"});
  options_.decimal = ',';
  const auto comma = read("Time [s];a [m/s2]\n0;1,234\n1;2,345\n");
  ASSERT_TRUE(comma);
  EXPECT_DOUBLE_EQ(comma->accel_mps2[0][0], 1.234);
  // One comma that can only be a decimal comma decides for the whole file.
  const auto told = read("Time;a [m/s2]\n0;1,234\n0,01;2,345\n");
  ASSERT_TRUE(told);
  EXPECT_DOUBLE_EQ(told->accel_mps2[0][1], 2.345);
  expect_refused("Time;a [g]\n0.5;1,25\n1.5;2,25\n", 2, {"0.5", "1,25", "comma"});
  expect_refused("Time;a [g]\n0;1.234,5\n0,01;2\n", 2, {"a", "1.234,5"});
  expect_refused("Time,a [g]\n0,01,0,5\n0,02,0,5\n", 2, {"4 fields", "semicolons"});
}

TEST_F(Table, AsksForTheUnitOfATimeThatCannotBeSeconds) {
  options_.unit_mps2 = 1;
  expect_refused("Time,a\n0,1\n10,2\n20,2\n", 1, {"0.1 Hz", "--time-unit"});
  options_.time_unit_s = 1e-3;
  options_.unit_mps2 = 1;
  expect_read("Time,a\n0,0.5\n10,-1\n");
  options_.time_unit_s = 1e-3;
  expect_refused("Time [ms],a [g]\n0,0.5\n10,-1\n", 1, {"--time-unit does not apply"});
  // Milliseconds since 1970.
  options_.time_unit_s = 1e-3;
  options_.unit_mps2 = 1;
  expect_read("timestamp,a\n1795408921140,0.5\n1795408921150,-1\n");
  expect_refused("timestamp,a [g]\n1795408921140,0.5\n1795408921150,-1\n", 2, {"--time-unit"});
  // Days of a spreadsheet in steps of 10 ms.
  expect_refused("Time;a [g]\n45987,5;1\n45987,500000116;1\n45987,500000231;1\n", 3,
                 {"spreadsheet's days"});
}

TEST_F(Table, ReadsTimeStampsWithTheirZone) {
  const auto record =
      read("Time,a [m/s2]\n2026-11-21T17:00:00.010Z,1\n2026-11-21T17:00:00.020Z,2\n");
  ASSERT_TRUE(record);
  EXPECT_NEAR(record->time_s[0], 1795280400.01, 1e-6);
  EXPECT_NEAR(record->rate_hz, 100, 0.01);
  const auto east =
      read("Time;a [m/s2]\n2026-11-22 02:00:00,010+09:00;1\n2026-11-22 02:00:00,020+09:00;2\n");
  ASSERT_TRUE(east);
  EXPECT_NEAR(east->time_s[0], 1795280400.01, 1e-6);
  expect_refused("Time,a [g]\n2026-11-21 17:00:00.01,1\n2026-11-21 17:00:00.02,1\n", 2, {"--zone"});
  options_.zone_min = 540;
  const auto declared = read("Time,a [g]\n2026-11-22 02:00:00.01,1\n2026-11-22 02:00:00.02,1\n");
  ASSERT_TRUE(declared);
  EXPECT_NEAR(declared->time_s[0], 1795280400.01, 1e-6);
  options_.zone_min = 540;
  const auto dots = read("Zeit;a [g]\n22.11.2026 02:00:00,01;1\n22.11.2026 02:00:00,02;1\n");
  ASSERT_TRUE(dots);
  EXPECT_NEAR(dots->time_s[0], 1795280400.01, 1e-6);
  expect_refused("Time,a [g]\n11.21.2026 17:00:00,1\n", 2, {"which number is the month"});
  expect_refused("Time,a [g]\n11/21/2026 17:00:00,1\n11/21/2026 17:00:01,1\n", 2,
                 {"which number is the month"});
  expect_refused("Time,a [g]\n17:00:00.01,1\n17:00:00.02,1\n", 2, {"without its date"});
  expect_refused("Time,a [g]\n2026-13-21T17:00:00Z,1\n", 2, {"2026-13-21", "no such time"});
  expect_refused("Time,a [g]\n2026-11-21T17:00:00Z,1\n5,1\n", 3, {"\"5\""});
}

TEST_F(Table, TakesTheTimeStampsOfAnUnnamedIndex) {
  const std::string pandas = ",a\n2026-11-21 17:00:00.000,0.5\n2026-11-21 17:00:00.010,-1\n";
  options_.unit_mps2 = kG;
  options_.zone_min = 0;
  const auto record = read(pandas);
  ASSERT_TRUE(record) << problems_[0].message;
  EXPECT_EQ(record->names, std::vector<std::string>{"a"});
  EXPECT_NEAR(record->time_s[0], 1795280400, 1e-6);
  EXPECT_DOUBLE_EQ(record->accel_mps2[0][1], -kG);
  options_.unit_mps2 = kG;
  options_.zone_min = 0;
  const auto semicolons = read(";a\n2026-11-21 17:00:00,00;0,5\n2026-11-21 17:00:00,01;-1,5\n");
  ASSERT_TRUE(semicolons) << problems_[0].message;
  EXPECT_DOUBLE_EQ(semicolons->accel_mps2[0][1], -1.5 * kG);
  expect_read(",Time,a [m/s2]\n0,0,0.5\n1,0.01,-1\n");
  options_.step_s = 0.01;
  expect_read(",a [m/s2]\n0,0.5\n1,-1\n");
  expect_refused(",a [m/s2]\n0,0.5\n1,-1\n", 1, {"--step"});
}

TEST_F(Table, ReadsTheHeaderOfGcdcLoggersInTheirRemarks) {
  options_.unit_mps2 = 2;
  expect_read(
      ";Title, http://www.gcdataconcepts.com, X16-1D\n;SampleRate, 100,Hz\n"
      ";Headers, time,a\n0.000,0.5\n0.010,-1\n;shutdown: a, b\n",
      2);
  options_.unit_mps2 = 1;
  expect_read("Time;a\n0;0,5\n0,01;-1\n");  // where ; separates columns, it begins no remark
  expect_refused("Time;a [g]\n;0,5\n0,01;-1\n", 2, {"time \"\""});
}

TEST_F(Table, ReadsTheFourHeaderLinesOfToa5) {
  const std::string head =
      "\"TOA5\",\"CR6\",\"CR6\",\"1\",\"CR6.Std.09\",\"CPU:test.CR6\",\"1\",\"A\"\n";
  const std::string text = head +
                           "\"TIMESTAMP\",\"RECORD\",\"a\",\"b\"\n\"TS\",\"RN\",\"g\",\"mg\"\n"
                           "\"\",\"\",\"Smp\",\"Smp\"\n\"2026-11-21 17:00:00\",7,0.5,100\n"
                           "\"2026-11-21 17:00:00.01\",8,-1,\"NAN\"\n";
  options_.zone_min = 0;
  const auto record = read(text);
  ASSERT_TRUE(record) << problems_[0].where << problems_[0].message;
  EXPECT_EQ(record->names, (std::vector<std::string>{"a", "b"}));
  EXPECT_NEAR(record->time_s[0], 1795280400, 1e-6);
  EXPECT_NEAR(record->rate_hz, 100, 0.01);
  EXPECT_DOUBLE_EQ(record->accel_mps2[0][1], -kG);
  EXPECT_DOUBLE_EQ(record->accel_mps2[1][0], 0.1 * kG);
  EXPECT_TRUE(std::isnan(record->accel_mps2[1][1]));
  EXPECT_NE(notes(*record).find("\"RECORD\": record numbers, left out"), std::string::npos);
  expect_refused(text, 5, {"does not say its zone"});
  options_.zone_min = 0;
  const std::size_t unit = text.find("\"mg\"");
  expect_refused(text.substr(0, unit) + "\"Volts\"" + text.substr(unit + 4), 2, {"\"Volts\""});
  options_.zone_min = 0;
  expect_refused(text.substr(0, text.find("\"TS\"")), 2, {"does not say the unit"});
  options_.zone_min = 0;
  expect_refused(head, 0, {"there is no header"});
}

TEST_F(Table, NeverInterleavesPossibleColumns) {
  const std::string text = "0.00 1 2\n0.01 3 4\n0.02 5 6\n";
  options_.unit_mps2 = 1;
  options_.step_s = 0.01;
  expect_refused(text, 1, {"3 numbers in every row", "--format columns", "--format rows"});
  options_.unit_mps2 = 1;
  options_.format = RecordFormat::columns;
  const auto columns = read(text);
  ASSERT_TRUE(columns);
  EXPECT_EQ(columns->names, (std::vector<std::string>{"rec.1", "rec.2"}));
  EXPECT_EQ(columns->accel_mps2[1], (std::vector<double>{2, 4, 6}));
  options_.unit_mps2 = 1;
  options_.step_s = 0.5;
  options_.format = RecordFormat::rows;
  const auto rows = read(text);
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->accel_mps2[0].size(), 9U);
}

TEST_F(Table, NamesUnnamedColumns) {
  options_.unit_mps2 = 1;
  options_.names = {"base", "roof"};
  options_.format = RecordFormat::columns;
  const auto record = read("0.00 1 2\n0.01 3 4\n");
  ASSERT_TRUE(record);
  EXPECT_EQ(record->names, (std::vector<std::string>{"base", "roof"}));
  options_.names = {"base"};
  expect_refused("Time,a [g],b [g]\n0,1,1\n0.01,1,1\n", 0, {"1 names", "2 channels"});
}

TEST_F(Table, RefusesMalformedOnes) {
  expect_refused("Time;a [g]\n0;1\n0,01;x\n", 3, {"a: \"x\""});
  expect_refused("Time;a [g]\nx;1\n0,01;1\n", 2, {"time \"x\""});
  expect_refused("Time;\"a [g]\n0;1\n", 1, {"quote is not closed"});
  expect_refused("Time;a [g]\n0;1\n\"0,01;1\n", 3, {"quote is not closed"});
  expect_refused("Time;a [g]\n", 0, {"at least 2 samples"});
  expect_refused("Time Acc x [g]\n0 1\n0.01 1\n", 2, {"2 fields where the header has 4", "blanks"});
  expect_refused("Time,a [g],b [g]\n0,1\n0.01,1,1\n", 2, {"2 fields where the header has 3"});
  expect_refused(std::string("\xFF\xFET\0i\0m\0e\0\n\0", 12), 1, {"UTF-16", "CSV UTF-8"});
}

}  // namespace table_test
}  // namespace framewatch::drivers
