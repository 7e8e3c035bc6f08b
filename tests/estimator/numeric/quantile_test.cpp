// SPDX-License-Identifier: MIT
#include "estimator/numeric/quantile.h"

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace quantile_test {

TEST(Quantile, MediansDifferOnlyForAnEvenNumberOfValues) {
  std::vector<double> odd{5, 1, 3}, even{7, 1, 5, 3};
  EXPECT_EQ(upper_median(odd), 3);
  EXPECT_EQ(lower_median(odd), 3);
  EXPECT_EQ(mean_median(odd), 3);
  EXPECT_EQ(upper_median(even), 5);
  EXPECT_EQ(lower_median(even), 3);
  EXPECT_EQ(mean_median(even), 4);
}

TEST(Quantile, IsTheValueOfTheNearestRank) {
  const std::vector<double> values{4, 0, 3, 1, 2};
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    EXPECT_EQ(quantile(values, share), 4 * share);
  EXPECT_EQ(quantile(values, 0.6), 2);
  EXPECT_EQ(quantile(values, 0.65), 3);
}

TEST(Quantile, WithoutValuesIsMissing) {
  std::vector<double> none;
  EXPECT_TRUE(std::isnan(upper_median(none)));
  EXPECT_EQ(upper_median(none, 2), 2);
  EXPECT_TRUE(std::isnan(mean_median({})));
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace quantile_test
}  // namespace framewatch::estimator
