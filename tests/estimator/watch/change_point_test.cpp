// SPDX-License-Identifier: MIT
#include "estimator/watch/change_point.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace change_point_test {

constexpr double kError = 0.01;

/// 5-s windows of value(i), each with kError times `wider` of noise and kError as its error.
template <typename Value>
std::vector<WindowValue> series(int count, Value value, std::uint64_t seed = 1, double wider = 1) {
  Random random(seed);
  std::vector<WindowValue> out;
  for (int i = 0; i < count; ++i)
    out.push_back({from_microseconds(5'000'000LL * i), from_microseconds(5'000'000LL * (i + 1)),
                   value(i) + wider * kError * random.normal(), kError});
  return out;
}

TEST(WindowMean, ItsErrorIncludesThatOfTheWeights) {
  // GIVEN windows whose errors are estimates from as many blocks as the estimator's
  constexpr int kSeries = 4000, kWindows = 8, kFreedom = 19;
  constexpr double kAgree = 0.05;  // relative
  Random random(5);
  double squares = 0, told = 0;
  for (int i = 0; i < kSeries; ++i) {
    auto values = series(
        kWindows, [](int) { return 1.0; }, static_cast<std::uint64_t>(i + 1));
    for (WindowValue& v : values) {
      double chi = 0;
      for (int n = 0; n < kFreedom; ++n) chi += std::pow(random.normal(), 2);
      v.std_error = kError * std::sqrt(chi / kFreedom);
    }
    const WindowMean mean = mean_of(values, 0, values.size());
    squares += std::pow((mean.value - 1) / mean.std_error, 2);
    told += mean.std_error;
  }
  // THEN the mean's error is not too small, and at most as much larger as the scatter makes it
  EXPECT_LT(std::sqrt(squares / kSeries), 1 + kAgree);
  EXPECT_GT(std::sqrt(squares / kSeries), 0.9);
  EXPECT_GT(told / kSeries, kError / std::sqrt(kWindows));
}

TEST(ChangePoint, IsFoundWithItsSizeErrorAndPlace) {
  const auto values = series(12, [](int i) { return i < 4 ? 1.0 : i == 4 ? 0.97 : 0.9; });
  const auto found = find_change(values, 0.05);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->before_end, 4u);
  EXPECT_EQ(found->after_begin, 5u);
  EXPECT_NEAR(found->ratio(), -0.1, 3 * found->std_error());
  EXPECT_LT(found->std_error(), 0.01);
  EXPECT_GT(found->std_error(), 0.004);
}

TEST(ChangePoint, IsFoundTwoWindowsLater) {
  const auto values = series(
      6, [](int i) { return i < 4 ? 1.0 : 0.9; }, 2);
  EXPECT_TRUE(find_change(values, 0.05));
  EXPECT_FALSE(find_change({values.begin(), values.end() - 1}, 0.05));
}

TEST(ChangePoint, IsNotFoundInAThousandSeriesOfNoise) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed)
    found += find_change(series(
                             40, [](int) { return 1.0; }, seed),
                         0.01)
                 .has_value();
  EXPECT_EQ(found, 0);
}

TEST(ChangePoint, IsNotFoundInScatterBeyondTheStatedErrors) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed)
    found += find_change(series(
                             40, [](int) { return 1.0; }, seed, 5),
                         0.01)
                 .has_value();
  EXPECT_EQ(found, 0);
}

TEST(ChangePoint, IsNotFoundInASlowDrift) {
  EXPECT_FALSE(find_change(series(40, [](int i) { return 1 - 0.005 * i; }), 0.05));
}

TEST(ChangePoint, LeavesOutWindowsWithoutAValue) {
  auto values = series(14, [](int i) { return i < 6 ? 1.0 : 0.9; });
  for (const std::size_t i : {0u, 3u, 9u}) values[i].value = kNaN;
  const auto found = find_change(values, 0.05);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->ratio(), -0.1, 3 * found->std_error());
  EXPECT_FALSE(find_change({}, 0.05));
  for (WindowValue& v : values) v.value = kNaN;
  EXPECT_FALSE(find_change(values, 0.05));
}

}  // namespace change_point_test
}  // namespace framewatch::estimator
