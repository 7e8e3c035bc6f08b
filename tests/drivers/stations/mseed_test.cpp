// SPDX-License-Identifier: MIT
// miniSEED files of framewatch and of recorders.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/formats/record_file.h"
#include "tests/support/miniseed.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace mseed_test {

constexpr std::int64_t kStart_us = 1'795'478'400'250'000;
constexpr double kCount_mps2 = 1e-5;

std::vector<double> counts(int from, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(std::round(3e4 * std::sin(0.1 * (from + i))));
  return out;
}

class Miniseed : public testing::Test {
 protected:
  Miniseed() { options_.unit_mps2 = kCount_mps2; }
  std::optional<Record> read(const std::string& bytes) {
    test::write_file(path_, bytes);
    problems_.clear();
    auto record = read_record(path_, options_, problems_);
    EXPECT_EQ(record.has_value(), problems_.empty());
    return record;
  }

  /// Returns the samples from index `from` on, on the clock of the channel.
  static test::SeedSpan span(int from, int count) {
    test::SeedSpan out;
    out.start_us = kStart_us + from * std::int64_t{10'000};
    out.values = counts(from, count);
    return out;
  }

  void expect_counts(const Record& record, std::size_t channel, std::size_t instant, int first,
                     int count) {
    const std::vector<double> expected = counts(first, count);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(record.accel_mps2[channel][instant + i], expected[i] * kCount_mps2) << i;
      ASSERT_EQ(record.time_s[instant + i],
                static_cast<double>(kStart_us + (first + static_cast<int>(i)) * 10'000L) / 1e6);
    }
  }

  std::string said(const std::optional<Record>& record) const {
    std::string all;
    for (const Problem& p : problems_) all += p.message + "\n";
    if (record)
      for (const std::string& note : record->notes) all += note + "\n";
    return all;
  }
  void expect_said(const std::optional<Record>& record, const std::string& part) const {
    EXPECT_NE(said(record).find(part), std::string::npos)
        << "not said: " << part << "\nbut " << said(record);
  }

  test::TemporaryDirectory directory_;
  const std::string path_ = directory_.path("quake");
  RecordOptions options_;
  std::vector<Problem> problems_;
};

TEST_F(Miniseed, EveryEncodingAndByteOrderGivesTheSameRecord) {
  for (const int encoding : {DE_STEIM1, DE_STEIM2, DE_INT16, DE_INT32, DE_FLOAT32, DE_FLOAT64})
    for (const int byte_order : {0, 1})
      for (const int bytes : {256, 512, 4096}) {
        SCOPED_TRACE(fmt::format("{} {} {}", encoding, byte_order, bytes));
        test::SeedSpan s = span(0, 3000);
        s.encoding = encoding;
        s.byte_order = byte_order;
        s.record_bytes = bytes;
        const auto record = read(miniseed(s));
        ASSERT_TRUE(record) << said(record);
        EXPECT_EQ(record->names, std::vector<std::string>{"XX.TEST.01.HN1"});
        EXPECT_NEAR(record->rate_hz, 100, 1e-6);
        ASSERT_EQ(record->time_s.size(), 3000U);
        expect_counts(*record, 0, 0, 0, 3000);
      }
}

TEST_F(Miniseed, RefusesCountsWithoutAUnit) {
  options_.unit_mps2.reset();
  const auto record = read(miniseed(span(0, 100)));
  expect_said(record, "does not say what a count is: declare it with --unit");
}

TEST_F(Miniseed, OptionsOfTablesDoNotApply) {
  options_.step_s = 0.01;
  options_.time_column = "t";
  const auto record = read(miniseed(span(0, 100)));
  expect_said(record, "--step does not apply");
  expect_said(record, "--time, --time-unit and --decimal are for tables");
}

TEST_F(Miniseed, ReadsInterleavedChannelsOfDifferentLengths) {
  test::SeedSpan a = span(0, 1000), b = span(5, 1000), c = span(1000, 1000);
  b.channel = "HN2";
  const auto record = read(miniseed(c) + miniseed(b) + miniseed(a));
  ASSERT_TRUE(record) << said(record);
  EXPECT_EQ(record->names, (std::vector<std::string>{"XX.TEST.01.HN1", "XX.TEST.01.HN2"}));
  ASSERT_EQ(record->time_s.size(), 2000U);
  expect_counts(*record, 0, 0, 0, 2000);
  expect_counts(*record, 1, 5, 5, 1000);
  EXPECT_TRUE(std::isnan(record->accel_mps2[1][4]));
  EXPECT_TRUE(std::isnan(record->accel_mps2[1][1005]));
  expect_said(
      record,
      "XX.TEST.01.HN2: 1000 of 2000 instants are before its first sample or after its last");
}

TEST_F(Miniseed, ColumnsAndNamesChooseAndNameChannels) {
  test::SeedSpan a = span(0, 500), b = span(0, 50);
  b.channel = "LN1";
  b.rate_hz = 10;
  const std::string both = miniseed(a) + miniseed(b);
  auto record = read(both);
  expect_said(record,
              "XX.TEST.01.HN1 has 100 Hz, XX.TEST.01.LN1 has 10 Hz: select those of one rate");
  options_.columns = {"XX.TEST.01.HN1"};
  options_.names = {"roof"};
  record = read(both);
  ASSERT_TRUE(record) << said(record);
  EXPECT_EQ(record->names, std::vector<std::string>{"roof"});
  expect_said(record, "XX.TEST.01.LN1: not one of --columns, left out");
  options_.columns = {"roof\x1b"};
  record = read(both);
  expect_said(record, "--columns \"roof?\": there is no such channel");
}

TEST_F(Miniseed, FillsAndReportsAGap) {
  const auto record = read(miniseed(span(0, 600)) + miniseed(span(750, 600)));
  ASSERT_TRUE(record) << said(record);
  ASSERT_EQ(record->time_s.size(), 1350U);
  expect_counts(*record, 0, 0, 0, 600);
  expect_counts(*record, 0, 750, 750, 600);
  for (std::size_t i = 600; i < 750; ++i) ASSERT_TRUE(std::isnan(record->accel_mps2[0][i]));
  expect_said(record, "an interruption of 1.5 s from 2026-11-24T00:00:06.250000Z on");
}

TEST_F(Miniseed, TakesRepeatedSamplesOnceAndRefusesContradictions) {
  const std::string first = miniseed(span(0, 600));
  auto record = read(first + first + miniseed(span(500, 300)));
  ASSERT_TRUE(record) << said(record);
  ASSERT_EQ(record->time_s.size(), 800U);
  expect_counts(*record, 0, 0, 0, 800);
  expect_said(record, "700 samples appear twice with equal values: used once");
  test::SeedSpan other = span(500, 300);
  other.values[0] += 1;
  record = read(first + miniseed(other));
  expect_said(record, "samples from 2026-11-24T00:00:05.250000Z on appear twice, with different");
}

TEST_F(Miniseed, RefusesSamplesOffTheTimeGrid) {
  test::SeedSpan later = span(600, 600);
  later.start_us += 3'000;
  const auto record = read(miniseed(span(0, 600)) + miniseed(later));
  expect_said(record, "are 0.30 of a step off those before");
}

TEST_F(Miniseed, KeepsTheTimesOfASlightlyWrongClock) {
  for (const bool microseconds : {true, false}) {
    std::string file;
    for (int i = 0; i < 200; ++i) {
      test::SeedSpan s = span(i * 100, 100);
      s.start_us += i * 30;  // 30 ppm
      s.microseconds = microseconds;
      file += miniseed(s);
    }
    const auto record = read(file);
    ASSERT_TRUE(record) << said(record);
    ASSERT_EQ(record->time_s.size(), 20'000U);
    EXPECT_NEAR(record->rate_hz, 100 / (1 + 30e-6), 1e-4);
    EXPECT_NEAR(record->time_s[19'900], 1e-6 * (kStart_us + 199'000'000L + 199 * 30),
                microseconds ? 1e-6 : 1e-4);
  }
}

TEST_F(Miniseed, LeavesOutAndReportsRecordsWithoutSamples) {
  test::SeedSpan log = span(0, 40);
  log.encoding = DE_ASCII;
  log.channel = "LOG";
  log.rate_hz = 0;
  auto record = read(miniseed(log) + miniseed(span(0, 300)));
  ASSERT_TRUE(record) << said(record);
  expect_said(record, "XX.TEST.01.LOG: 1 records without samples, left out");
  record = read(miniseed(log));
  expect_said(record, "there are no samples");
}

TEST_F(Miniseed, ReportsDamageWithItsPlace) {
  const std::string good = miniseed(span(0, 3000));
  auto record = read(good.substr(0, good.size() - 100));
  expect_said(record, "the last record is cut off");
  std::string broken = good;
  broken.replace(1024, 512, std::string(512, '#'));
  record = read(broken);
  expect_said(record, "byte 1024: no miniSEED record is here");
  broken = good;
  broken.replace(512 + 64, 448, std::string(448, '\xff'));
  record = read(broken);
  EXPECT_FALSE(record);
}

/// Returns Steim-1 records of `length` bytes without any blockette, as old recorders write them.
std::string without_blockettes(int length) {
  test::SeedSpan span;
  span.start_us = kStart_us;
  span.encoding = DE_STEIM1;
  span.record_bytes = length;
  span.values = counts(0, 3000);
  span.microseconds = false;
  std::string bytes = miniseed(span);
  for (std::size_t at = 0; at < bytes.size(); at += static_cast<std::size_t>(length)) {
    bytes[at + 39] = 0;                   // number of blockettes
    bytes[at + 46] = bytes[at + 47] = 0;  // offset of the first
  }
  return bytes;
}

TEST_F(Miniseed, ReadsRecordsThatDoNotStateTheirLength) {
  const std::string bytes = without_blockettes(1024);
  ASSERT_GT(bytes.size(), 3 * 1024U);
  const auto record = read(bytes);
  ASSERT_TRUE(record) << said(record);
  ASSERT_EQ(record->accel_mps2[0].size(), 3000U);
  for (std::size_t i = 0; i < 3000; ++i)
    ASSERT_EQ(record->accel_mps2[0][i], counts(0, 3000)[i] * kCount_mps2) << i;
  const auto one = read(bytes.substr(0, 1024));
  ASSERT_TRUE(one) << said(one);
  EXPECT_EQ(one->accel_mps2[0][5], record->accel_mps2[0][5]);
  for (const std::size_t cut : {100, 500, 900})
    expect_said(read(bytes.substr(0, bytes.size() - cut)), "the last record is cut off");
  expect_said(read(bytes.substr(0, 1000)), "the last record is cut off");
}

TEST_F(Miniseed, TakesSamplesThatLookLikeAHeaderAsSamples) {
  for (const int byte_order : {0, 1}) {
    test::SeedSpan quiet = span(0, 100);
    quiet.encoding = DE_INT32;
    quiet.byte_order = byte_order;
    quiet.values.assign(200, 0);
    quiet.values[60] = 6;  // where SAC has its version
    quiet.values[63] = 5;  // and its number of samples
    const auto record = read(miniseed(quiet));
    ASSERT_TRUE(record) << said(record);
    EXPECT_EQ(record->names, std::vector<std::string>{"XX.TEST.01.HN1"});
  }
}

TEST_F(Miniseed, ReadsGzip) {
  test::write_file(path_, miniseed(span(0, 3000)));
  ASSERT_EQ(std::system(("gzip " + path_).c_str()), 0);
  const auto record = read_record(path_ + ".gz", options_, problems_);
  ASSERT_TRUE(record) << said(record);
  expect_counts(*record, 0, 0, 0, 3000);
}

TEST_F(Miniseed, NamesRelatedFormatsThatItDoesNotRead) {
  auto record = read("MS\x03" + std::string(100, '\0'));
  expect_said(record, "is miniSEED 3, which is not supported: write miniSEED 2");
  record = read("000001V 010009502.3121992,001" + std::string(300, ' '));
  expect_said(record, "is a full SEED volume");
}

TEST_F(Miniseed, DoesNotGuessADeclaredFormat) {
  options_.format = RecordFormat::mseed;
  const auto record = read("time_s,a\n0,1\n0.01,2\n");
  expect_said(record, "byte 0: no miniSEED record is here");
}

TEST(UnreadFormats, AreRefusedWithAdvice) {
  test::TemporaryDirectory directory;
  const auto refused = [&](const std::string& name, const std::string& bytes) {
    test::write_file(directory.path(name), bytes);
    std::vector<Problem> problems;
    EXPECT_FALSE(read_record(directory.path(name), {}, problems));
    EXPECT_EQ(problems.size(), 1U);
    return problems.empty() ? "" : problems[0].message;
  };
  const std::string instead = "export it as CSV or MATLAB .mat";
  for (const auto& [name, bytes, word] : std::vector<std::array<std::string, 3>>{
           {"a.mf4", "MDF     4.10    " + std::string(200, '\0'), "ASAM MDF"},
           {"a.mdf", "UnFinMF 4.10    " + std::string(200, '\0'), "ASAM MDF, unfinished"},
           {"a.uff", "    -1\n    58\nAcceleration\n", "a Universal File (UFF, UNV)"},
           {"b.unv", "    -1\r\n    58b     1     2\r\n", "a Universal File (UFF, UNV)"},
           {"a.h5", "\x89HDF\r\n\x1a\n" + std::string(200, '\0'), "HDF5"}}) {
    const std::string message = refused(name, bytes);
    EXPECT_NE(message.find(word), std::string::npos) << name << ": " << message;
    EXPECT_NE(message.find(instead), std::string::npos) << name << ": " << message;
  }
  std::string sac_text;
  for (int i = 0; i < 14; ++i)
    sac_text += "     0.01000000     -12345.00      -12345.00       0.5       1\n";
  sac_text +=
      "      2020         1         0         0         0\n         0         6         0 1 2\n";
  const std::string level_4("\0\0\0\0\x03\0\0\0\x01\0\0\0\0\0\0\0\x04\0\0\0acc\0", 24),
      big_level_4(
          "\0\0\x03\xe8\0\0\0\x03\0\0\0\x01\0\0\0\0\0\0\0\x04"
          "acc\0",
          24),
      event("K\x01\x01\x09\0\0\0\x01\x07\xf8\0\0\0\0\0\0", 16);
  for (const auto& [name, bytes, word, advice] : std::vector<std::array<std::string, 4>>{
           {"a.npy", "\x93NUMPY\x01" + std::string(100, '\0'), "NumPy array", "numpy.savetxt"},
           {"a.xlsx", "PK\x03\x04" + std::string(100, '\0'), "Excel workbook (.xlsx)", "CSV UTF-8"},
           {"a.xls", "\xD0\xCF\x11\xE0" + std::string(100, '\0'), "workbook (.xls)", "CSV UTF-8"},
           {"a.tdms", "TDSm" + std::string(100, '\0'), "LabVIEW TDMS", "npTDMS"},
           {"a.lvm", "LabVIEW Measurement\t\nWriter_Version\t2\n", "(.lvm)", "lvm_read"},
           {"a.sac", sac_text, "alphanumeric form of SAC", "binary SAC"},
           {"a.mat", level_4 + std::string(24, '\0'), "MATLAB file of level 4", "-v7"},
           {"b.mat", big_level_4 + std::string(24, '\0'), "MATLAB file of level 4", "-v7"},
           {"a.evt", event + std::string(2040, '\0'), "Kinemetrics recorder", "ObsPy"}}) {
    const std::string message = refused(name, bytes);
    EXPECT_NE(message.find(word), std::string::npos) << name << ": " << message;
    EXPECT_NE(message.find(advice), std::string::npos) << name << ": " << message;
  }
}

}  // namespace mseed_test
}  // namespace framewatch::drivers
