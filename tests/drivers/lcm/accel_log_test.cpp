// SPDX-License-Identifier: MIT
#include "drivers/lcm/accel_log.h"

#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "drivers/lcm/lcm_log.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace accel_log_test {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

class AccelLog : public testing::Test {
 protected:
  /// Writes a log of single samples {time_us, node, x}.
  void write_samples(const std::vector<std::tuple<std::int64_t, std::int32_t, double>>& samples) {
    LcmLogWriter log;
    ASSERT_TRUE(log.open(path_));
    for (const auto& [time_us, node, x] : samples) {
      const auto bytes =
          encode_accel({estimator::from_microseconds(time_us), 0, node, {x, kMissing, kMissing}});
      ASSERT_TRUE(log.write(time_us, "ACCEL", bytes.data(), bytes.size()));
    }
    ASSERT_TRUE(log.close());
  }

  test::TemporaryDirectory directory_;
  std::string path_ = directory_.path("a.lcmlog");
  std::vector<Problem> problems_;
};

TEST_F(AccelLog, ReadsBackItsRecord) {
  Record record{{"F1", "F2", "G"}, {}, {{}, {}, {}}, 100, {}, {}, {}};
  for (int i = 0; i < 250; ++i) {
    record.time_s.push_back(i / 100.0);
    for (int c = 0; c < 3; ++c)
      record.accel_mps2[static_cast<std::size_t>(c)].push_back(c == 1 && i == 7 ? kMissing
                                                                                : i + 0.1 * c);
  }
  ASSERT_EQ(write_accel_log(path_, record, {{"A", 4, 1}, {"A", 4, 0}, {"A", 2, 2}}, 5'000'000), "");

  const auto contents = log_contents(path_, problems_);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->accel, std::vector<std::string>{"A"});
  EXPECT_EQ(contents->others, std::vector<std::string>{"A_CHANNELS"});
  EXPECT_EQ(contents->events, 2 * 250 + 3);  // tables at 0, 1 and 2 s
  const auto back = read_accel_log(path_, "A", problems_);
  ASSERT_TRUE(back) << problems_.at(0).message;
  EXPECT_EQ(back->names, record.names);
  ASSERT_EQ(back->time_s.size(), 250U);
  EXPECT_DOUBLE_EQ(back->time_s[3], 5.03);
  EXPECT_TRUE(std::isnan(back->accel_mps2[1][7]));
  EXPECT_EQ(back->accel_mps2[0], record.accel_mps2[0]);
  EXPECT_EQ(back->accel_mps2[2], record.accel_mps2[2]);
}

TEST_F(AccelLog, SortsALiveLogAndNotesItsIrregularities) {
  write_samples({{0, 0, 1},
                 {0, 1, 10},
                 {20000, 0, 3},
                 {10000, 0, 2},
                 {10000, 0, 9},
                 {10000, 1, std::numeric_limits<double>::infinity()},
                 {20000, 1, 12},
                 {40000, 0, 5}});
  const auto record = read_accel_log(path_, "ACCEL", problems_);
  ASSERT_TRUE(record) << problems_.at(0).message;
  EXPECT_EQ(record->names, (std::vector<std::string>{"node0.x", "node1.x"}));
  ASSERT_EQ(record->time_s.size(), 5U);
  EXPECT_EQ(record->accel_mps2[0][1], 2);
  EXPECT_TRUE(std::isnan(record->accel_mps2[0][3]));
  EXPECT_TRUE(std::isnan(record->accel_mps2[1][1]));
  EXPECT_TRUE(std::isnan(record->accel_mps2[1][4]));
  EXPECT_EQ(record->notes.size(), 3U);
}

TEST_F(AccelLog, KeepsAMostlySilentNode) {
  std::vector<std::tuple<std::int64_t, std::int32_t, double>> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({i * 10000, 7, i});
  samples.push_back({30000, 3, 0.5});
  samples.push_back({900000, 3, 0.25});
  samples.push_back({500000, 4, 0.125});
  write_samples(samples);
  const auto record = read_accel_log(path_, "ACCEL", problems_);
  ASSERT_TRUE(record) << problems_.at(0).message;
  ASSERT_EQ(record->time_s.size(), 100U);
  EXPECT_EQ(record->names, (std::vector<std::string>{"node3.x", "node4.x", "node7.x"}));
  EXPECT_EQ(record->accel_mps2[0][90], 0.25);
  EXPECT_EQ(record->accel_mps2[1][50], 0.125);
  EXPECT_NEAR(record->rate_hz, 100, 1e-9);
}

TEST_F(AccelLog, RefusesForeignAndDamagedLogs) {
  LcmLogWriter log;
  ASSERT_TRUE(log.open(path_));
  ASSERT_TRUE(log.close());
  EXPECT_FALSE(log_contents(path_, problems_));
  EXPECT_EQ(problems_.at(0).message, "the log is empty");

  write_samples({{0, 0, 1}, {10000, 0, 2}, {20000, 0, 3}});
  const std::string whole = test::read_file(path_);
  for (const std::string& bytes : {whole.substr(0, whole.size() - 3), whole.substr(5)}) {
    problems_.clear();
    test::write_file(path_, bytes);
    EXPECT_FALSE(read_accel_log(path_, "ACCEL", problems_));
    EXPECT_NE(problems_.at(0).where.find("byte"), std::string::npos);
  }
  problems_.clear();
  std::string foreign = whole;
  foreign[whole.find("ACCEL") + 5] ^= 1;
  test::write_file(path_, foreign);
  EXPECT_FALSE(read_accel_log(path_, "ACCEL", problems_));
  EXPECT_EQ(problems_.at(0).message, "ACCEL: the message is not an accel_t");
}

}  // namespace accel_log_test
}  // namespace framewatch::drivers
