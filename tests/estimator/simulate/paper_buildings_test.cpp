// SPDX-License-Identifier: MIT
#include "tests/support/paper_buildings.h"

#include <gtest/gtest.h>

#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"
#include "tests/support/data.h"

namespace framewatch::test {
namespace paper_buildings_test {

/// Half of the last digit that method.md section 1 states.
constexpr double kLowestLimit = 0.005;
constexpr double kHighestLimit = 0.05;

void expect_frequencies(const estimator::Structure& s, const Eigen::VectorXd& theta,
                        double lowest_hz, double highest_hz) {
  const auto f = natural_frequencies_hz(s, estimator::ParameterTable(s), theta);
  EXPECT_NEAR(f.front(), lowest_hz, kLowestLimit);
  EXPECT_NEAR(f.back(), highest_hz, kHighestLimit);
}

TEST(PaperBuildings, HaveThePublishedFrequencies) {
  expect_frequencies(table1(), table1_theta(), 0.37, 2.8);
  expect_frequencies(table2(), table2_theta('b'), 1.07, 3.8);
  expect_frequencies(table2(), table2_theta('c'), 1.08, 7.7);
  expect_frequencies(table2(), table2_theta('d'), 1.08, 9.9);
}

TEST(PaperBuildings, AreBuildingsWithSensorsEverywhere) {
  for (const estimator::Structure& s : {table1(), table2()}) {
    EXPECT_TRUE(problems(s).empty());
    EXPECT_TRUE(problems(s, full_sensor_axes(s)).empty());
  }
}

TEST(PaperBuildings, RecordsHaveTheStatedPeaks) {
  FRAMEWATCH_DATA_OR_SKIP(path, "ground_motions/elcentro_NS.dat");
  const auto el_centro = el_centro_ns();
  const auto hachinohe = hachinohe_ns();
  ASSERT_TRUE(el_centro && hachinohe);
  EXPECT_EQ(el_centro->accel.size(), 2688u);
  EXPECT_NEAR(el_centro->peak(), 3.42, 0.005);
  EXPECT_EQ(hachinohe->accel.size(), 3601u);
  EXPECT_NEAR(hachinohe->peak(), 2.2477, 1e-4);
}

}  // namespace paper_buildings_test
}  // namespace framewatch::test
