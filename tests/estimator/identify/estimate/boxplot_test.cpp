// SPDX-License-Identifier: MIT
#include "estimator/identify/estimate/boxplot.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace boxplot_test {

/// MATLAB's rule as its documentation words it, for the finite values.
BoxplotStatistics by_definition(const std::deque<double>& window) {
  std::vector<double> v;
  for (const double x : window)
    if (!std::isnan(x)) v.push_back(x);
  std::sort(v.begin(), v.end());
  const auto n = static_cast<double>(v.size());
  const auto quantile = [&](double p) {
    const double place = p * n + 0.5;  // 1-based; exact for quarters
    if (place <= 1) return v.front();
    if (place >= n) return v.back();
    const auto i = static_cast<std::size_t>(place);
    return v[i - 1] + (place - static_cast<double>(i)) * (v[i] - v[i - 1]);
  };
  BoxplotStatistics out{quantile(0.25), quantile(0.5), quantile(0.75), kNaN, kNaN, 0, 0};
  const double reach = 1.5 * (out.q3 - out.q1);
  for (const double x : v) {
    if (x < out.q1 - reach || x > out.q3 + reach) {
      ++out.outliers;
      continue;
    }
    if (std::isnan(out.whisker_low)) out.whisker_low = x;
    out.whisker_high = x;
  }
  out.count = static_cast<int>(v.size());
  return out;
}

void expect_same(const BoxplotStatistics& a, const BoxplotStatistics& b) {
  ASSERT_EQ(a.count, b.count);
  ASSERT_EQ(a.outliers, b.outliers);
  ASSERT_NEAR(a.q1, b.q1, 1e-12);
  ASSERT_NEAR(a.median, b.median, 1e-12);
  ASSERT_NEAR(a.q3, b.q3, 1e-12);
  ASSERT_EQ(a.whisker_low, b.whisker_low);
  ASSERT_EQ(a.whisker_high, b.whisker_high);
}

TEST(Boxplot, AgreesWithItsDefinitionOnRandomDataWithTiesAndNaN) {
  Random random(2);
  for (const int windows : {1, 2, 7, 40}) {
    BoxplotWindow box(windows);
    std::deque<double> window;
    for (int i = 0; i < 1500; ++i) {
      double x = std::round(4 * random.normal()) + (random.uniform() < 0.05 ? 50 : 0);
      if (random.uniform() < 0.1 || (i > 700 && i < 760)) x = kNaN;
      box.push(x);
      window.push_back(x);
      if (window.size() > static_cast<std::size_t>(windows)) window.pop_front();
      if (std::all_of(window.begin(), window.end(), [](double v) { return std::isnan(v); })) {
        EXPECT_EQ(box.statistics().count, 0);
        EXPECT_TRUE(std::isnan(box.statistics().median));
      } else {
        expect_same(box.statistics(), by_definition(window));
      }
    }
  }
}

TEST(Boxplot, FiveHundredValuesHaveMatlabsPositions) {
  BoxplotWindow box(500);
  for (int i = 0; i < 500; ++i) box.push(std::pow((i * 77) % 500 + 1, 2));  // squares, shuffled
  const auto x = [](int i) { return std::pow(i, 2); };
  const BoxplotStatistics s = box.statistics();
  EXPECT_DOUBLE_EQ(s.q1, (x(125) + x(126)) / 2);
  EXPECT_DOUBLE_EQ(s.median, (x(250) + x(251)) / 2);
  EXPECT_DOUBLE_EQ(s.q3, (x(375) + x(376)) / 2);
  EXPECT_EQ(s.whisker_low, 1);
  EXPECT_EQ(s.whisker_high, 250000);
  EXPECT_EQ(s.outliers, 0);
}

TEST(Boxplot, AValueOnTheFenceIsNotAnOutlier) {
  BoxplotWindow box(8);
  for (const double v : {0., 0., 1., 1., 1., 2., 2., 3.5}) box.push(v);
  const BoxplotStatistics s = box.statistics();  // q1 0.5, q3 2: the upper fence is 4.25
  EXPECT_EQ(s.outliers, 0);
  box.push(4.25);  // the oldest 0 leaves: q1 1, q3 2.75, fence 5.375
  EXPECT_EQ(box.statistics().whisker_high, 4.25);
}

TEST(Boxplot, ResetForgets) {
  BoxplotWindow box(3);
  box.push(1);
  box.reset();
  EXPECT_EQ(box.statistics().count, 0);
  box.push(5);
  EXPECT_EQ(box.statistics().median, 5);
}

}  // namespace boxplot_test
}  // namespace framewatch::estimator
