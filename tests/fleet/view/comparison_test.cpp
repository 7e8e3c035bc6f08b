// SPDX-License-Identifier: MIT
#include "fleet/view/comparison.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace framewatch::fleet {
namespace comparison_test {

// Limits.
constexpr int kTables = 300, kStiffnesses = 100, kPeriods = 10;
constexpr int kMaxFalse = 30;           // tables of 300 with a false loss; 15 are expected
constexpr double kTenThousand = 4.417;  // standard errors: 0.05 / 10000, one-sided

Level level(const std::vector<float>& medians, float error) {
  return level_of(medians, std::vector<float>(medians.size(), error));
}

TEST(Comparison, LevelIsTheMedianWithItsError) {
  const Level l = level({10, 12, 11, 100}, 1);
  EXPECT_DOUBLE_EQ(l.value, 11.5);
  EXPECT_EQ(l.periods, 4);
  // The windows' error, if the periods scatter less.
  EXPECT_NEAR(level({10, 10, 10, 10}, 2).std_error, 1.2533 * 2 / 2, 1e-3);
  // The scatter, if it is larger: MAD of 8, 9, 11, 12 about 10 is 1.5.
  EXPECT_NEAR(level({8, 9, 11, 12}, 0.1F).std_error, 1.2533 * 1.4826 * 1.5 / 2, 1e-3);
}

TEST(Comparison, ComparesNothingWithoutValues) {
  Comparison c;
  c.after = level({10}, 1);
  compare(c);
  EXPECT_FALSE(c.compared);
  c.before = level({0}, 1);
  compare(c);
  EXPECT_FALSE(c.compared);
}

TEST(Comparison, LossIsARatioWithItsError) {
  Comparison c;
  c.before = {100, 1, 10};
  c.after = {85, 2, 10};
  compare(c);
  ASSERT_TRUE(c.compared);
  EXPECT_NEAR(c.ratio, -0.15, 1e-12);
  EXPECT_NEAR(c.std_error, std::hypot(0.02, 0.0085), 1e-12);
  EXPECT_LT(c.times_error(), -6);
}

TEST(Comparison, MoreComparisonsRaiseTheThreshold) {
  EXPECT_NEAR(significant_errors(10'000), kTenThousand, 2e-3);
  EXPECT_GT(significant_errors(120'000), significant_errors(120));
  EXPECT_NEAR(significant_errors(0), significant_errors(1), 1e-12);
}

TEST(Comparison, ChanceSeldomLooksLikeALoss) {
  std::mt19937 random(7);
  std::normal_distribution<float> value(100, 3);
  const auto periods = [&] {
    std::vector<float> out(kPeriods);
    for (float& v : out) v = value(random);
    return out;
  };
  const double limit = significant_errors(kStiffnesses);
  int falsely = 0;
  for (int t = 0; t < kTables; ++t) {
    bool loss = false;
    for (int i = 0; i < kStiffnesses; ++i) {
      Comparison c;
      c.before = level(periods(), 3);
      c.after = level(periods(), 3);
      compare(c);
      loss = loss || c.times_error() < -limit;
    }
    falsely += loss ? 1 : 0;
  }
  EXPECT_LE(falsely, kMaxFalse);
}

}  // namespace comparison_test
}  // namespace framewatch::fleet
