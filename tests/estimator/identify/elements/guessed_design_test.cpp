// SPDX-License-Identifier: MIT
#include "estimator/identify/elements/guessed_design.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace guessed_design_test {

/// Applies retuned_design to one ratio and error for all unknowns, all shown, theta order.
struct Bench {
  Structure structure = test::table1();
  ParameterTable table{structure};
  FloorLayout layout{structure, table};
  Eigen::VectorXd design = test::table1_theta();
  std::vector<double> ratio = std::vector<double>(50, 1.0), error = std::vector<double>(50, 0.0);
  std::vector<std::uint8_t> shown = std::vector<std::uint8_t>(50, 1);
  /// Returns the internal position of a parameter.
  std::size_t unknown(const char* name) const {
    for (int u = 0; u < layout.unknowns(); ++u)
      if (table[layout.parameter(u / layout.own(), u % layout.own())].name == name)
        return static_cast<std::size_t>(u);
    return 999;
  }
  double factor(const char* name) const {
    const int p = *table.find(name);
    RetuningWork work(table.size());
    Eigen::VectorXd out(table.size());
    retuned_design(layout, table, design, ratio, error, shown, work, out);
    return out[p] / design[p];
  }
};

TEST(Design, GuessHasATenthOfASecondPerStory) {
  for (const Structure& s : {test::table1(), test::table2()}) {
    const ParameterTable table(s);
    const Eigen::VectorXd theta = guessed_design(s, table);
    EXPECT_GT(theta.minCoeff(), 0);
    const double period = 1 / natural_frequencies_hz(s, table, theta).front();
    EXPECT_NEAR(period / (0.1 * s.stories), 1, 0.1);
  }
}

TEST(Design, AdoptsExactRatios) {
  Bench b;
  b.ratio[b.unknown("ky_3_x2")] = 0.4;
  EXPECT_NEAR(b.factor("ky_3_x2"), 0.4, 1e-12);
  EXPECT_NEAR(b.factor("ky_3_x1"), 1, 1e-12);
}

TEST(Design, MovesLessByUncertainRatios) {
  Bench b;
  const std::size_t u = b.unknown("kx_2_y1");
  b.ratio[u] = 2;
  b.error[u] = 0.1 * 2;  // a relative error of a tenth: half the way, in logarithms
  EXPECT_NEAR(b.factor("kx_2_y1"), std::sqrt(2.0), 1e-12);
  b.error[u] = 100;
  EXPECT_NEAR(b.factor("kx_2_y1"), 1, 1e-3);
}

TEST(Design, MovesAtMostFiveTimesAtOnce) {
  Bench b;
  b.ratio[b.unknown("cx_1_y1")] = 40;
  b.ratio[b.unknown("Gk_2_x1y1")] = 0.01;
  EXPECT_NEAR(b.factor("cx_1_y1"), 5, 1e-12);
  EXPECT_NEAR(b.factor("Gk_2_x1y1"), 0.2, 1e-12);
}

TEST(Design, MovesUnobservableElementsWithTheirKind) {
  Bench b;
  for (int u = 0; u < 50; ++u) {
    const auto kind = b.table[b.layout.parameter(u / b.layout.own(), u % b.layout.own())].kind;
    if (kind == ParameterKind::frame_stiffness) b.ratio[static_cast<std::size_t>(u)] = 3;
  }
  b.shown[b.unknown("kx_4_y2")] = false;
  EXPECT_NEAR(b.factor("kx_4_y2"), 3, 1e-12);
  b.ratio[b.unknown("kx_4_y1")] = -1;  // impossible: treated as not shown
  EXPECT_NEAR(b.factor("kx_4_y1"), 3, 1e-12);
}

TEST(Design, StaysIfNothingIsObservable) {
  Bench b;
  b.ratio.assign(50, 3.0);
  b.shown.assign(50, 0);
  EXPECT_EQ(b.factor("kx_1_y1"), 1);
  EXPECT_EQ(b.factor("Gc_5_x1y1"), 1);
}

}  // namespace guessed_design_test
}  // namespace framewatch::estimator
