// SPDX-License-Identifier: MIT
// MATLAB files as records.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <zlib.h>

#include "drivers/formats/record_file.h"
#include "tests/support/mat.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace mat_test {

constexpr double kG = 9.80665;
constexpr std::size_t kSamples = 500;

std::vector<double> times(double step = 0.01) {
  std::vector<double> out;
  for (std::size_t i = 0; i < kSamples; ++i) out.push_back(step * static_cast<double>(i));
  return out;
}

std::vector<double> values(int channel) {
  std::vector<double> out;
  for (std::size_t i = 0; i < kSamples; ++i) out.push_back(channel + 1e-3 * static_cast<double>(i));
  return out;
}

std::vector<double> joined(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out = a;
  out.insert(out.end(), b.begin(), b.end());
  return out;
}

class Mat : public testing::Test {
 protected:
  Mat() { options_.unit_mps2 = kG; }
  std::optional<Record> read() {
    problems_.clear();
    auto record = read_record(path_, options_, problems_);
    EXPECT_EQ(record.has_value(), problems_.empty());
    return record;
  }
  std::string said(const std::optional<Record>& record) const {
    std::string all;
    for (const Problem& p : problems_) all += p.where + ": " + p.message + "\n";
    if (record)
      for (const std::string& note : record->notes) all += note + "\n";
    return all;
  }
  void expect_said(const std::optional<Record>& record, const std::string& part) const {
    EXPECT_NE(said(record).find(part), std::string::npos)
        << "not said: " << part << "\nbut " << said(record);
  }
  void expect_channels(const std::vector<std::string>& names, double unit_mps2 = kG) {
    const auto record = read();
    ASSERT_TRUE(record) << said(record);
    EXPECT_EQ(record->names, names);
    ASSERT_EQ(record->time_s.size(), kSamples);
    EXPECT_NEAR(record->rate_hz, 100, 1e-6);
    for (std::size_t c = 0; c < names.size(); ++c) {
      const std::vector<double> expected = values(static_cast<int>(c) + 1);
      for (std::size_t i = 0; i < kSamples; ++i)
        ASSERT_EQ(record->accel_mps2[c][i], expected[i] * unit_mps2) << c << " " << i;
    }
  }

  test::TemporaryDirectory directory_;
  const std::string path_ = directory_.path("run");
  RecordOptions options_;
  std::vector<Problem> problems_;
};

TEST_F(Mat, ReadsTheSameFromEveryFormatLevel) {
  for (const auto level : {MAT_FT_MAT5, MAT_FT_MAT73})
    for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
      SCOPED_TRACE(fmt::format("{:x} {}", static_cast<int>(level), static_cast<int>(compression)));
      std::remove(path_.c_str());
      test::MatWriter(path_, level, compression)
          .add_column("t", times())
          .add("acc", joined(values(1), values(2)), kSamples, 2)
          .add_column("roof", values(3))
          .add_text("who", "a\x1b[31mb");
      const auto record = read();
      ASSERT_TRUE(record) << said(record);
      EXPECT_EQ(record->names.size(), 3U);
      expect_said(record, "\"who\": 1 x ");
      expect_said(record, "char, left out");
      expect_said(record, "\"t\" is taken as seconds: 100 Hz");
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& name = record->names[c];
        const int channel = name == "acc.1" ? 1 : name == "acc.2" ? 2 : 3;
        EXPECT_TRUE(name == "acc.1" || name == "acc.2" || name == "roof") << name;
        for (std::size_t i = 0; i < kSamples; ++i)
          ASSERT_EQ(record->accel_mps2[c][i], values(channel)[i] * kG);
      }
    }
}

TEST_F(Mat, TakesRowsAsChannelsIfTheirLengthMatchesTheTimes) {
  std::vector<double> across;
  for (std::size_t i = 0; i < kSamples; ++i) {
    across.push_back(values(1)[i]);
    across.push_back(values(2)[i]);
  }
  test::MatWriter(path_).add("time", times(), 1, kSamples).add("acc", across, 2, kSamples);
  expect_channels({"acc.1", "acc.2"});
  expect_said(read(), "\"acc\": its 2 rows are channels");
}

TEST_F(Mat, FieldsOfAStructAreVariables) {
  test::MatWriter(path_).add_struct("run", {"Time", "base", "roof"},
                                    {times(), values(1), values(2)});
  expect_channels({"base", "roof"});
}

TEST_F(Mat, KeepsTheNamesOfStructsBesideOtherVariables) {
  test::MatWriter(path_)
      .add_struct("run", {"t", "base"}, {times(), values(1)})
      .add_column("roof", values(2));
  expect_said(read(), "name it with --time");
  options_.time_column = "run.t";
  expect_channels({"run.base", "roof"});
}

TEST_F(Mat, FindsTheTimesInAMatrixByColumnName) {
  test::MatWriter(path_).add("data", joined(times(), values(1)), kSamples, 2);
  expect_said(read(), "name it with --time, or give the seconds");
  expect_said(read(), "the file holds \"data\" (500 x 2 double)");
  options_.time_column = "data.1";
  expect_channels({"data.2"});
}

TEST_F(Mat, NeedsTheStepWithoutTimes) {
  test::MatWriter(path_).add("acc", joined(values(1), values(2)), kSamples, 2);
  options_.step_s = 0.01;
  expect_channels({"acc.1", "acc.2"});
}

TEST_F(Mat, SelectsAMatrixOrOneLineOfItWithColumns) {
  test::MatWriter(path_)
      .add_column("t", times())
      .add("acc", joined(values(1), values(2)), kSamples, 2)
      .add_column("load", values(7))
      .add_column("spectrum", {1, 2, 3});
  expect_said(
      read(),
      "there are 500 times, and variables of other lengths: name the channels with --columns");
  options_.columns = {"acc"};
  expect_channels({"acc.1", "acc.2"});
  expect_said(read(), "\"spectrum\": not one of --columns, left out");
  options_.columns = {"acc.1"};
  expect_channels({"acc.1"});
  options_.columns = {"none"};
  expect_said(read(), "--columns \"none\": there is no such column");
}

TEST_F(Mat, AsksForTheUnitUnlessFramewatchWroteTheFile) {
  options_.unit_mps2.reset();
  test::MatWriter(path_).add_column("base", values(1)).add_column("t", times());
  expect_said(read(), "a MATLAB file does not say its unit: declare it with --unit");
  test::MatWriter(path_).add_column("base", values(1)).add_column("time_s", times());
  expect_channels({"base"}, 1);
}

TEST_F(Mat, AsksForTheUnitOfTimesThatCannotBeSeconds) {
  test::MatWriter(path_).add_column("t", times(10)).add_column("a", values(1));
  expect_said(read(), "declare it with --time-unit");
  options_.time_unit_s = 1e-3;
  expect_channels({"a"});
}

TEST_F(Mat, AsksAboutSeveralTimesAndSquareMatrices) {
  test::MatWriter(path_)
      .add_column("t", times())
      .add_column("time", times())
      .add_column("a", values(1));
  expect_said(read(), "several columns are times: \"t\", \"time\"");
  options_.time_column = "t";
  options_.columns = {"a"};
  expect_channels({"a"});
  options_ = {};
  options_.unit_mps2 = 1;
  test::MatWriter(path_).add_column("t", {0, 0.01}).add("a", {1, 2, 3, 4}, 2, 2);
  expect_said(read(), "\"a\": 2 x 2 double: its rows or its columns can be the channels");
}

TEST_F(Mat, ReportsVariablesThatAreNotRealNumbers) {
  test::MatWriter(path_)
      .add_column("t", times())
      .add_column("a", values(1))
      .add_complex("z", values(1));
  expect_said(
      read(),
      "\"z\": 500 x 1 complex double cannot be a channel: name the channels with --columns");
  options_.columns = {"a"};
  expect_channels({"a"});
  expect_said(read(), "\"z\": 500 x 1 complex double, left out");
  options_.columns = {"z"};
  expect_said(read(), "\"z\": 500 x 1 complex double cannot be a channel or the times");
}

TEST_F(Mat, ReadsEveryNumberTypeButNoLogicals) {
  const std::vector<double> wanted = {1, 2, 3};
  test::MatWriter(path_)
      .add_column("t", {0, 0.01, 0.02})
      .add_as<float>("f", MAT_C_SINGLE, MAT_T_SINGLE, {1, 2, 3})
      .add_as<std::int8_t>("i8", MAT_C_INT8, MAT_T_INT8, {1, 2, 3})
      .add_as<std::uint8_t>("u8", MAT_C_UINT8, MAT_T_UINT8, {1, 2, 3})
      .add_as<std::int16_t>("i16", MAT_C_INT16, MAT_T_INT16, {1, 2, 3})
      .add_as<std::uint16_t>("u16", MAT_C_UINT16, MAT_T_UINT16, {1, 2, 3})
      .add_as<std::int32_t>("i32", MAT_C_INT32, MAT_T_INT32, {1, 2, 3})
      .add_as<std::uint32_t>("u32", MAT_C_UINT32, MAT_T_UINT32, {1, 2, 3})
      .add_as<std::int64_t>("i64", MAT_C_INT64, MAT_T_INT64, {1, 2, 3})
      .add_as<std::uint64_t>("u64", MAT_C_UINT64, MAT_T_UINT64, {1, 2, 3})
      .add_as<std::uint8_t>("on", MAT_C_UINT8, MAT_T_UINT8, {1, 0, 1}, MAT_F_LOGICAL);
  options_.unit_mps2 = 1;
  const auto record = read();
  ASSERT_TRUE(record) << said(record);
  EXPECT_EQ(record->names.size(), 9U);
  for (const auto& channel : record->accel_mps2) EXPECT_EQ(channel, wanted);
  expect_said(record, "\"on\": 3 x 1 logical, left out");
}

TEST_F(Mat, TakesNanAsMissingAndRefusesInfinity) {
  std::vector<double> a = values(1);
  a[7] = std::numeric_limits<double>::quiet_NaN();
  test::MatWriter(path_).add_column("t", times()).add_column("a", a);
  const auto record = read();
  ASSERT_TRUE(record) << said(record);
  EXPECT_TRUE(std::isnan(record->accel_mps2[0][7]));
  expect_said(record, "a: 1 of 500 samples have no value");
  a[7] = std::numeric_limits<double>::infinity();
  test::MatWriter(path_).add_column("t", times()).add_column("a", a);
  expect_said(read(), "\"a\": sample 8 is infinite");
}

TEST_F(Mat, RefusesATruncatedOrDamagedFile) {
  for (const auto level : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    std::remove(path_.c_str());
    test::MatWriter(path_, level, MAT_COMPRESSION_ZLIB)
        .add_column("t", times())
        .add_column("a", values(1))
        .add_column("b", values(2));
    const std::string whole = test::read_file(path_);
    ASSERT_TRUE(read());
    for (std::size_t bytes = 100; bytes < whole.size(); bytes += 211) {
      test::write_file(path_, whole.substr(0, bytes));
      ASSERT_FALSE(read()) << bytes << " of " << whole.size();
    }
  }
}

TEST_F(Mat, RefusesAnImpossibleSizeBeforeAllocating) {
  test::MatWriter(path_).add_column("t", times()).add_column("a", values(1));
  std::string bytes = test::read_file(path_);
  // The dimensions of "a", as int32: 500 x 1.
  const std::string size("\xf4\x01\x00\x00\x01\x00\x00\x00", 8);
  const std::size_t at = bytes.rfind(size);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 8, std::string("\xf4\x01\x00\x00\xff\xff\xff\x0f", 8));
  test::write_file(path_, bytes);
  EXPECT_FALSE(read());
}

/// Returns bytes of a little-endian number.
std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
  return out;
}

/// Returns the element of a column of zeros without its values, for a file of level 5. MathWorks,
/// "MAT-File Format", chapter 1.
std::string zeros_head(const std::string& name, std::uint32_t rows) {
  std::string padded = name;
  padded.resize((name.size() + 7) / 8 * 8, '\0');
  const std::string parts = little(6, 4) + little(8, 4) + little(6, 8) + little(5, 4) +
                            little(8, 4) + little(rows, 4) + little(1, 4) + little(1, 4) +
                            little(name.size(), 4) + padded;
  const std::uint64_t bytes = 8 * std::uint64_t{rows};
  return little(14, 4) + little(parts.size() + 8 + bytes, 4) + parts + little(9, 4) +
         little(bytes, 4);
}

/// Returns a file with one compressed column of that many zeros.
std::string compressed_zeros(std::uint32_t rows) {
  z_stream stream{};
  deflateInit(&stream, 9);
  std::string packed;
  const auto add = [&](std::string bytes, int flush) {
    std::string to(1 << 16, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(to.data());
      stream.avail_out = static_cast<uInt>(to.size());
      deflate(&stream, flush);
      packed.append(to, 0, to.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  };
  add(zeros_head("a", rows), Z_NO_FLUSH);
  for (std::uint64_t left = 8 * std::uint64_t{rows}; left > 0;) {
    const std::uint64_t part = std::min<std::uint64_t>(left, 1 << 20);
    add(std::string(part, '\0'), Z_NO_FLUSH);
    left -= part;
  }
  add("", Z_FINISH);
  deflateEnd(&stream);
  std::string head = "MATLAB 5.0 MAT-file";
  head.resize(116, ' ');
  return head + std::string(8, '\0') + std::string("\x00\x01IM", 4) + little(15, 4) +
         little(packed.size(), 4) + packed;
}

TEST_F(Mat, RefusesACompressedVectorBeforeItFillsMemory) {
  constexpr std::int64_t kMost_kB = 100'000;
  options_.step_s = 0.01;
  test::write_file(path_, compressed_zeros(34'000'000));
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  expect_said(read(), "\"a\" has 34000000 samples: a record holds at most");
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, kMost_kB);
  test::write_file(path_, compressed_zeros(1000));
  const auto record = read();
  ASSERT_TRUE(record) << said(record);
  EXPECT_EQ(record->time_s.size(), 1000U);
}

TEST_F(Mat, LeavesOutTheVariableThatMatlabAddsForItsObjects) {
  test::MatWriter(path_).add_column("t", times()).add_column("a", values(1));
  std::string bytes = test::read_file(path_);
  std::string own = zeros_head("", 3);
  own[16] = 9;  // class uint8, with three bytes of values
  const std::size_t values_at = own.size() - 8;
  own.replace(values_at, 8, little(2, 4) + little(3, 4) + std::string(8, '\0'));
  own.replace(4, 4, little(own.size() - 8, 4));
  test::write_file(path_, bytes + own);
  const auto record = read();
  ASSERT_TRUE(record) << said(record);
  EXPECT_EQ(record->names, std::vector<std::string>{"a"});
}

TEST_F(Mat, RefusesColumnsWithoutUnitThatDifferInLengthFromTheTimes) {
  std::vector<double> time_ms = times();
  for (double& time : time_ms) time *= 1000;
  test::MatWriter(path_).add_column("time_ms", time_ms).add_column("a", {1, 2, 3});
  options_.time_column = "time";
  options_.columns = {"a"};
  expect_said(read(), "\"a\" has 3 samples, \"time_ms\" has 500");
}

TEST_F(Mat, RefusesAFileThatRefersToOthers) {
  const auto made = [&](const auto& add) {
    std::remove(path_.c_str());
    test::MatWriter(path_, MAT_FT_MAT73).add_column("t", times()).add_column("a", values(1));
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    add(file);
    H5Fclose(file);
    return read();
  };
  ASSERT_TRUE(made([](hid_t) {}));
  EXPECT_FALSE(made([](hid_t file) {
    H5Lcreate_external("/etc/passwd", "/", file, "other", H5P_DEFAULT, H5P_DEFAULT);
  }));
  expect_said({}, "refers to other files, which are never opened");
  EXPECT_FALSE(made([](hid_t file) {
    const hsize_t size = 500;
    const hid_t plist = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &size, nullptr);
    H5Pset_external(plist, "/dev/zero", 0, 4000);
    H5Dclose(H5Dcreate2(file, "b", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, plist, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(plist);
  }));
  expect_said({}, "refers to other files, which are never opened");
}

TEST_F(Mat, DoesNotGuessADeclaredFormat) {
  options_.format = RecordFormat::mat;
  test::write_file(path_, "t,a\n0,1\n0.01,2\n");
  expect_said(read(), "is not a MATLAB file of level 5 or 7.3");
  options_.format = RecordFormat::detect;
  test::MatWriter(path_).add_column("t", times()).add_column("a", values(1));
  ASSERT_EQ(std::system(("gzip -S .gz " + path_).c_str()), 0);
  ASSERT_EQ(std::system(("mv " + path_ + ".gz " + path_).c_str()), 0);
  expect_said(read(), "unpack it first (gunzip)");
}

}  // namespace mat_test
}  // namespace framewatch::drivers
