// SPDX-License-Identifier: MIT
#include "drivers/formats/record_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/data.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace record_file_test {

constexpr double kG = 9.80665;
constexpr double kGal = 0.01;

/// Reads texts as record files and checks the record or the problems.
class RecordFile : public testing::Test {
 protected:
  std::optional<Record> read(const std::string& text, const RecordOptions& options = {}) {
    test::write_file(path_, text);
    problems_.clear();
    auto record = read_record(path_, options, problems_);
    EXPECT_EQ(record.has_value(), problems_.empty());
    return record;
  }

  /// Expects a problem at this line (0: the file) that contains `rule`.
  void expect_refused(const std::string& text, int line, const std::string& rule,
                      const RecordOptions& options = {}) {
    SCOPED_TRACE(text.substr(0, 200));
    EXPECT_FALSE(read(text, options));
    const std::string where = line > 0 ? path_ + ":" + std::to_string(line) : path_;
    const bool found = std::any_of(problems_.begin(), problems_.end(), [&](const Problem& p) {
      return p.where == where && p.message.find(rule) != std::string::npos;
    });
    EXPECT_TRUE(found) << "expected at " << where << ": " << rule;
    for (const Problem& p : problems_)
      if (!found) ADD_FAILURE() << p.where << ": " << p.message;
  }

  test::TemporaryDirectory directory_;
  std::string path_ = directory_.path("rec.dat");
  std::vector<Problem> problems_;
};

RecordOptions declared(std::optional<double> unit_mps2, std::optional<double> step_s = {}) {
  RecordOptions options;
  options.unit_mps2 = unit_mps2;
  options.step_s = step_s;
  return options;
}

double peak(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest;
}

TEST_F(RecordFile, ReadsCsv) {
  const auto record = read(
      "\xEF\xBB\xBF# a note, \xC2\xA9\r\ntime_s, a "
      ",b-2\r\n0,1,-2.5e-1\r\n\r\n0.5,+3,4\r\n1,,nan\r\n");
  ASSERT_TRUE(record);
  EXPECT_EQ(record->names, (std::vector<std::string>{"a", "b-2"}));
  EXPECT_EQ(record->time_s, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(record->accel_mps2[1][0], -0.25);
  EXPECT_EQ(record->accel_mps2[0][1], 3);
  EXPECT_TRUE(std::isnan(record->accel_mps2[0][2]));
  EXPECT_TRUE(std::isnan(record->accel_mps2[1][2]));
  EXPECT_DOUBLE_EQ(record->rate_hz, 2);
  EXPECT_EQ(record->notes.size(), 2U);
}

TEST_F(RecordFile, LeavesOutALastRowThatMayBeTruncated) {
  const auto record = read("time_s,a\n0,1\n0.5,2\n1,-12.5");
  ASSERT_TRUE(record);
  EXPECT_EQ(record->time_s, (std::vector<double>{0, 0.5}));
  ASSERT_EQ(record->notes.size(), 1U);
  EXPECT_NE(record->notes[0].find("line 4: the last row has no line end"), std::string::npos);
}

TEST_F(RecordFile, LeavesOutANumberAtTheEndThatMayBeTruncated) {
  const auto expect_left_out = [&](const std::string& text, const RecordOptions& options,
                                   const std::string& note, std::size_t samples) {
    SCOPED_TRACE(text);
    const auto record = read(text, options);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->time_s.size(), samples);
    ASSERT_FALSE(record->notes.empty());
    EXPECT_NE(record->notes[0].find(note + " has no line end"), std::string::npos)
        << record->notes[0];
  };
  expect_left_out("1 2 3\n4 5 6\n7 8", declared(1, 0.1), "line 3: the last number", 7);
  expect_left_out("1\n2\n3", declared(1, 0.1), "line 3: the last number", 2);
  expect_left_out("0 1\n1 2\n2 3", declared(1), "line 3: the last row", 2);
  expect_left_out(
      "PEER NGA\nEVENT\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 3, DT= .01 SEC\n1 2 3", {},
      "line 5: the last number", 2);
  expect_left_out(
      "PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z\n0,1,1,1,1\n1,8334,1,1,1\n2,16667,1,1,9", {},
      "line 4: the last row", 2);
}

TEST_F(RecordFile, ReadsTheExponentsOfFortranDoubles) {
  const auto record = read(" 0.0D+00 0.5D+00\n 1.0D-02 -2.5d-03\n 2.0D-02 1.0D+01\n", declared(1));
  ASSERT_TRUE(record);
  EXPECT_EQ(record->accel_mps2[0], (std::vector<double>{0.5, -0.0025, 10}));
  EXPECT_NEAR(record->rate_hz, 100, 1e-9);
  expect_refused("0 1\n1 2D\n", 2, "2D", declared(1));
  expect_refused("0 1\n1 2D1\n", 2, "2D1", declared(1));
  expect_refused("0 1\n1 2D+x\n", 2, "2D+x", declared(1));
}

TEST_F(RecordFile, FillsLossesOfWholeStepsWithNan) {
  const auto record = read("time_s,a\n0,1\n0.01,2\n0.02,3\n0.05,6\n0.06,7\n");
  ASSERT_TRUE(record);
  ASSERT_EQ(record->time_s.size(), 7U);
  EXPECT_NEAR(record->time_s[3], 0.03, 1e-12);
  EXPECT_TRUE(std::isnan(record->accel_mps2[0][3]));
  EXPECT_TRUE(std::isnan(record->accel_mps2[0][4]));
  EXPECT_EQ(record->accel_mps2[0][5], 6);
  EXPECT_EQ(record->notes,
            std::vector<std::string>{"2 instants are missing and were filled with NaN"});
}

TEST_F(RecordFile, FindsTheRateBehindRoundedTimes) {
  std::string text = "time_s,a\n";
  for (int i = 0; i < 241; ++i) {
    char line[32];
    std::snprintf(line, sizeof line, "%.3f,0\n", i / 120.0);
    text += line;
  }
  const auto record = read(text);
  ASSERT_TRUE(record);
  EXPECT_NEAR(record->rate_hz, 120, 0.01);
  EXPECT_EQ(record->time_s.size(), 241U);
}

TEST_F(RecordFile, RefusesMalformedCsv) {
  expect_refused("", 0, "empty");
  expect_refused("time_s\n0\n1\n", 1, "no channel");
  expect_refused("time_s,a\n", 0, "at least 2 samples");
  expect_refused("time_s,a\n0,1\n", 0, "at least 2 samples");
  expect_refused("time_s,a,a\n0,1,1\n1,1,1\n", 1, "appears twice");
  expect_refused("time_s,a,\n0,1,1\n1,1,1\n", 1, "name is empty");
  expect_refused("time_s,\"a\"\"b\"\n0,1\n1,1\n", 1, "must not contain");
  expect_refused("time_s,a\n0,1\n1,2,3\n2,1\n", 3, "3 fields where the header has 2");
  expect_refused("time_s,a\n0,1\n1\n2,1\n", 3, "1 fields");
  expect_refused("time_s,a\n0,1\n1,x2\n2,1\n", 3, "a: \"x2\"");
  expect_refused("time_s,a\n0,1\n1,1,\n2,1\n", 3, "3 fields");
  expect_refused("time_s,a\n0,1\n1,1.5m\n2,1\n", 3, "1.5m");
  expect_refused("time_s,a\n0,1\n1,inf\n2,1\n", 3, "neither a finite number");
  expect_refused("time_s,a\n0,1\n1,1e999\n2,1\n", 3, "1e999");
  expect_refused("time_s,a\n0,1\nnan,1\n2,1\n", 3, "time");
  expect_refused("time_s,a\n0,1\n1,1\n1,1\n", 4, "must increase");
  expect_refused("time_s,a\n0,1\n1,1\n0.5,1\n", 4, "must increase");
  expect_refused("time_s,a\n0,1\n1,1\n2,1\n3.3,1\n4,1\n", 5, "uneven step");
  expect_refused("time_s,a\n0,1\n1,1\n1e8,1\n", 4, "more samples are missing");
  expect_refused("time_s,a\n0,1\n1e-7,1\n2e-7,1\n", 0, "rates above");
  expect_refused(std::string("time_s,a\n0,1\n\0,1\n", 17), 3, "not a text file");
  expect_refused(
      "\x7f"
      "ELF\x02\x01",
      1, "not a text file");
  expect_refused("hello\nworld\n", 0, "no known record format");
  expect_refused("time_s,a\n0,1\n" + std::string(2 << 20, '1'), 3, "longer than");
  expect_refused("time_s,a\n0,1\n1,1\n", 1, "--unit does not apply", declared(kG));
  expect_refused("time_s,a\n0,1\n1,1\n", 1, "--step does not apply", declared({}, 0.1));
}

TEST_F(RecordFile, ReportsEveryProblemButAtMostTwenty) {
  EXPECT_FALSE(read("time_s,a\n0,x\n1,y\n2\n"));
  EXPECT_EQ(problems_.size(), 3U);
  std::string text = "time_s,a\n";
  for (int i = 0; i < 1000; ++i) text += "0,x\n";
  EXPECT_FALSE(read(text));
  EXPECT_EQ(problems_.size(), 21U);
}

TEST_F(RecordFile, ReadsEveryVariantOfAt2) {
  const std::string head = "PEER NGA\nEVENT, 180\nACCELERATION TIME SERIES IN UNITS OF G\n";
  for (const std::string counts : {"NPTS=   7, DT=   .0050 SEC,", "NPTS= 7, DT= 0.005 SEC",
                                   "   7    0.0050    NPTS, DT", "NPTS=7 DT=.005"}) {
    SCOPED_TRACE(counts);
    const auto record = read(head + counts +
                             "\n  .1000000E-02  -.2000000E-02-.3000000E-02 .4E+00 1.234-5.678\n"
                             "  1e-3\n");
    ASSERT_TRUE(record);
    const std::vector<double> expected = {.001, -.002, -.003, .4, 1.234, -5.678, .001};
    ASSERT_EQ(record->time_s.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_DOUBLE_EQ(record->accel_mps2[0][i], expected[i] * kG);
    EXPECT_NEAR(record->rate_hz, 200, 1e-9);
    EXPECT_EQ(record->names, std::vector<std::string>{"rec"});
  }
}

TEST_F(RecordFile, RefusesMalformedAt2) {
  const std::string head = "PEER NGA\nEVENT\nACCELERATION TIME SERIES IN UNITS OF G\n";
  expect_refused(head + "NPTS= 3, DT= .01 SEC\n1 2\n", 4, "holds 2 values");
  expect_refused(head + "NPTS= 3, DT= .01 SEC\n1 2 3 4\n", 4, "holds 4 values");
  expect_refused(head + "NPTS= 3, DT= .01 SEC\n1 2 q\n", 5, "\"q\"");
  expect_refused(head + "NPTS= 3, DT= .01 SEC\n1 2 inf\n", 5, "finite");
  expect_refused(head + "NPTS= -3, DT= .01 SEC\n1 2 3\n", 4, "NPTS and DT");
  expect_refused(head + "NPTS= 3, DT= 0 SEC\n1 2 3\n", 4, "NPTS and DT");
  expect_refused("a\nb\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 3, DT= .01\n1 2 3\n", 3,
                 "units of g");
  RecordOptions forced;
  forced.format = RecordFormat::at2;
  expect_refused("a\nb\n", 0, "four header lines", forced);
}

TEST_F(RecordFile, ReadsTwoColumnsAndRowsWithDeclaredUnit) {
  const auto two = read("0 1\n0.5\t2\n1;3\n", declared(kG));
  ASSERT_TRUE(two);
  EXPECT_DOUBLE_EQ(two->accel_mps2[0][2], 3 * kG);
  const auto one = read("1\n2\n3\n", declared(kGal, 0.25));
  ASSERT_TRUE(one);
  EXPECT_DOUBLE_EQ(one->accel_mps2[0][2], 0.03);
  EXPECT_DOUBLE_EQ(one->time_s[2], 0.5);
  const auto rows = read("1 2 3\n4 5 6\n7\n*** End Data ***\n", declared(1.0, 1));
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->accel_mps2[0], (std::vector<double>{1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(RecordFile, RefusesMalformedColumns) {
  expect_refused("0 1\n1 2\n", 0, "declare it with --unit");
  expect_refused("1\n2\n", 0, "--step", declared(kG));
  expect_refused("1\n2\n", 0, "positive", declared(kG, -1));
  expect_refused("1\n2\n", 0, "positive", declared(kG, std::nan("")));
  expect_refused("0 1\n1 2 3\n2 3\n", 2, "3 values", declared(kG));
  expect_refused("0 1\n1\n2 3\n", 2, "1 values", declared(kG));
  expect_refused("0 1\n1 1,5.x\n", 2, "3 values", declared(kG));
  expect_refused("0 1\n0 1\n", 2, "must increase", declared(kG));
  expect_refused("0 1\n1 inf\n2 1\n", 2, "finite", declared(kG));
  expect_refused("0 1\n1 1e308\n2 1\n", 2, "more than a number can hold", declared(kG));
  expect_refused("1 2 3\n4 5\n6 7 8\n", 2, "ragged", declared(kG, 1));
  expect_refused("1 2 3\n4 5 6 7\n", 2, "ragged", declared(kG, 1));
  expect_refused("1\n2\nend\n", 3, "\"end\"", declared(kG, 1));
  expect_refused("1\n2\n*** End\n3\n", 4, "more rows after", declared(kG, 1));
}

const char* const kXsensHead =
    "sep=,\nDeviceTag:,Xsens DOT\n\xA9 Movella\n\n"
    "PacketCounter,SampleTimeFine,Euler_X,Acc_X,Acc_Y,Acc_Z\n";

TEST_F(RecordFile, ReadsXsensOverClockWrapAndLostSamples) {
  const auto record = read(std::string(kXsensHead) +
                           "7,4294950000,1,0.0,0.0,0.0\n"
                           "8,4294958333,1,1,2,9\n"
                           "9,4294966666,1,3,4,9\n"
                           "10,7703,1,5,6,9\n"
                           "13,32702,1,NaN,7,9\n"
                           "14,41035,1,8,9,10\n");
  ASSERT_TRUE(record);
  EXPECT_EQ(record->names, (std::vector<std::string>{"x", "y", "z"}));
  ASSERT_EQ(record->time_s.size(), 7U);
  EXPECT_DOUBLE_EQ(record->time_s.front(), 4294.958333);
  EXPECT_DOUBLE_EQ(record->time_s.back(), 4294.967296 + 0.041035);
  EXPECT_TRUE(std::isnan(record->accel_mps2[1][3]) && std::isnan(record->accel_mps2[1][4]));
  EXPECT_TRUE(std::isnan(record->accel_mps2[0][5]));
  EXPECT_EQ(record->accel_mps2[1][5], 7);
  std::string notes;
  for (const auto& note : record->notes) notes += note + "\n";
  for (const char* part : {"line 6: the all-zero first row", "jumps 1 times", "wraps", "gravity",
                           "2 instants are missing", "x: 1 of 5"})
    EXPECT_NE(notes.find(part), std::string::npos) << part << " in\n" << notes;
}

TEST_F(RecordFile, RefusesMalformedXsens) {
  const std::string head = kXsensHead;
  expect_refused(head, 0, "at least 2 samples");
  expect_refused(head + "0,1,1,1,1,1\n1,8334,1,1,1\n", 7, "5 fields");
  expect_refused(head + "0,1,1,1,1,1\n1,8334.5,1,1,1,1\n", 7, "not a whole number");
  expect_refused(head + "0,1,1,1,1,1\n1,4294967296,1,1,1,1\n", 7, "32 bits");
  expect_refused(head + "0,8334,1,1,1,1\n1,1,1,1,1,1\n2,16667,1,1,1,1\n", 7, "must increase");
  expect_refused(head + "0,1,1,1,1,1\n1,8334,1,1,ab,1\n", 7, "Acc_Y");
  expect_refused(head + "0,1,1,1,1,1\n1,8334,1,-inf,1,1\n", 7, "Acc_X");
  expect_refused("PacketCounter,SampleTimeFine,Acc_X,Acc_Y\n1,2,3,4\n", 1, "no column Acc_Z");
  expect_refused("PacketCounter,SampleTimeFine,Acc_X,Acc_X,Acc_Y,Acc_Z\n", 1, "twice");
}

TEST_F(RecordFile, RefusesUnreadableFiles) {
  EXPECT_FALSE(read_record(directory_.path("none.csv"), {}, problems_));
  EXPECT_NE(problems_.at(0).message.find("cannot be opened"), std::string::npos);
  problems_.clear();
  EXPECT_FALSE(read_record(directory_.path(""), {}, problems_));
  EXPECT_EQ(problems_.at(0).message, "cannot be opened: is a directory, not a file");
}

TEST_F(RecordFile, RefusesTruncatedAndDamagedGzip) {
  FRAMEWATCH_DATA_OR_SKIP(path, "practice/case-004/record_1.csv.gz");
  const std::string whole = test::read_file(path);
  ASSERT_TRUE(read(whole));
  EXPECT_FALSE(read(whole.substr(0, whole.size() / 2)));
  EXPECT_NE(problems_.at(0).message.find("cut off"), std::string::npos) << problems_[0].message;
  std::string damaged = whole;
  for (std::size_t i = damaged.size() / 2; i < damaged.size() / 2 + 64; ++i) damaged[i] ^= 0x55;
  EXPECT_FALSE(read(damaged));
}

struct GroundMotion {
  const char* file;
  double unit;
  std::optional<double> step_s;
  std::size_t points;
  double peak;        ///< in its unit, as PROVENANCE.txt states
  double peak_error;  ///< half the last digit stated
  double rate_hz;
};

TEST_F(RecordFile, ReadsTheGroundMotionsWithTheirKnownPeaks) {
  const std::vector<GroundMotion> motions = {
      {"elcentro_NS.dat", kG, {}, 2688, 0.34874, 5e-6, 50},
      {"elcentro_EW.dat", kG, {}, 2674, 0.2141, 5e-5, 50},
      {"elcacc1.txt", kGal, 0.01, 5376, 341.7, 0.05, 100},
      {"hachi.txt", kGal, 0.01, 3601, 224.77, 0.005, 100},
      {"kobe.txt", kGal, 0.01, 4998, 817, 1.0, 100},
      {"north.txt", kGal, 0.01, 2999, 825.9, 0.1, 100},
      {"mexico.txt", kGal, 0.01, 18011, 97.8, 0.2, 100},
      {"elCentro_peknold_opensees.dat", kG, 0.02, 1559, 0.3188, 5e-5, 50},
  };
  for (const GroundMotion& motion : motions) {
    SCOPED_TRACE(motion.file);
    FRAMEWATCH_DATA_OR_SKIP(path, std::string("ground_motions/") + motion.file);
    const auto record = read_record(path, declared(motion.unit, motion.step_s), problems_);
    ASSERT_TRUE(record) << problems_.at(0).message;
    EXPECT_EQ(record->time_s.size(), motion.points);
    EXPECT_NEAR(peak(record->accel_mps2[0]) / motion.unit, motion.peak, motion.peak_error);
    EXPECT_NEAR(record->rate_hz, motion.rate_hz, 1e-6);
    EXPECT_TRUE(record->notes.empty());
  }
}

TEST_F(RecordFile, ReadsTheFourLevelsOfTheShakingTable) {
  const std::string run = "mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story/";
  for (const char* level :
       {"Ground_Floor/(Northridge)Xsens_DOT", "1st_Floor/(Northridge)Xsens_DOT",
        "2nd_Floor/(Northridge)left_leg", "3rd_Floor_top/(Northridge)Xsens_DOT"}) {
    SCOPED_TRACE(level);
    FRAMEWATCH_DATA_OR_SKIP(path, run + level + "_20250306_122607.csv.gz");
    const auto record = read_record(path, {}, problems_);
    ASSERT_TRUE(record) << problems_.at(0).message;
    EXPECT_EQ(record->time_s.size(), 12116U);
    EXPECT_NEAR(record->rate_hz, 120, 0.01);
    EXPECT_GT(record->time_s.back() - record->time_s.front(), 100);
    EXPECT_LT(record->time_s.back() - record->time_s.front(), 105);
    EXPECT_DOUBLE_EQ(record->time_s.front(), 991.020030);
  }
}

TEST_F(RecordFile, ReadsThePracticeRecords) {
  FRAMEWATCH_DATA_OR_SKIP(path, "practice/case-053/record_1.csv.gz");
  const auto record = read_record(path, {}, problems_);
  ASSERT_TRUE(record) << problems_.at(0).message;
  EXPECT_EQ(record->names.size(), 18U);
  EXPECT_NEAR(record->rate_hz, 200, 1e-6);
}

}  // namespace record_file_test
}  // namespace framewatch::drivers
