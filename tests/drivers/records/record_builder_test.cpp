// SPDX-License-Identifier: MIT
#include "drivers/records/record_builder.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace record_builder_test {

/// Values 0, 1, 2, ... in one column of `name`.
Record ramp(const std::string& name, double begin_s, double step_s, std::size_t rows) {
  Record record{{name}, {}, {{}}, 1 / step_s, {}, {}, {}};
  for (std::size_t i = 0; i < rows; ++i) {
    record.time_s.push_back(begin_s + static_cast<double>(i) * step_s);
    record.accel_mps2[0].push_back(static_cast<double>(i));
  }
  return record;
}

std::string problem(std::vector<Record> records) {
  std::vector<Problem> problems;
  EXPECT_FALSE(merge_records(std::move(records), {"a", "b"}, MergeSpan::common, problems));
  return problems.empty() ? "" : problems[0].where + ": " + problems[0].message;
}

TEST(RecordMerge, KeepsTheCommonInstants) {
  std::vector<Problem> problems;
  const auto merged = merge_records({ramp("a", 10, 0.01, 100), ramp("b", 10.0203, 0.01, 100)},
                                    {"a", "b"}, MergeSpan::common, problems);
  ASSERT_TRUE(merged);
  ASSERT_EQ(merged->time_s.size(), 98U);
  EXPECT_DOUBLE_EQ(merged->time_s.front(), 10.02);
  EXPECT_EQ(merged->accel_mps2[0].front(), 2);
  EXPECT_EQ(merged->accel_mps2[1].front(), 0);
  EXPECT_EQ(merged->accel_mps2[1].back(), 97);
  EXPECT_EQ(merged->notes.size(), 2U);
}

TEST(RecordMerge, KeepsAllInstantsWithHoles) {
  std::vector<Problem> problems;
  const auto merged = merge_records({ramp("a", 1, 0.01, 10), ramp("b", 0.98, 0.01, 20)}, {"a", "b"},
                                    MergeSpan::all, problems);
  ASSERT_TRUE(merged);
  ASSERT_EQ(merged->time_s.size(), 20U);
  EXPECT_NEAR(merged->time_s.front(), 0.98, 1e-12);
  EXPECT_NEAR(merged->time_s.back(), 1.17, 1e-12);
  EXPECT_TRUE(std::isnan(merged->accel_mps2[0][1]));
  EXPECT_EQ(merged->accel_mps2[0][2], 0);
  EXPECT_EQ(merged->accel_mps2[1][19], 19);
}

TEST(RecordMerge, RefusesRecordsThatDoNotFitTogether) {
  const Record a = ramp("a", 0, 0.01, 100);
  EXPECT_EQ(problem({a, ramp("b", 2, 0.01, 100)}).substr(0, 29), "b: the clocks do not overlap:");
  EXPECT_EQ(problem({a, ramp("b", 0, 0.02, 50)}).substr(0, 15), "b: rates differ");
  EXPECT_EQ(problem({a, ramp("b", 0.004, 0.01, 100)}).substr(0, 32),
            "b: the clocks are not synchroniz");
  EXPECT_EQ(problem({ramp("a", 0, 0.01, 1000), ramp("b", 0, 0.010005, 1000)}).substr(0, 32),
            "b: the clocks are not synchroniz");
  EXPECT_EQ(problem({a, a}), "b: channel name a appears twice");
  EXPECT_NE(problem({a, ramp("b", 0.99, 0.01, 100)}).find("fewer than 2"), std::string::npos);
}

}  // namespace record_builder_test
}  // namespace framewatch::drivers
