// SPDX-License-Identifier: MIT
#include "estimator/modes/mode_shapes.h"

#include <cmath>
#include <complex>
#include <initializer_list>

#include <gtest/gtest.h>

#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace mode_shapes_test {

Eigen::VectorXcd shape(std::initializer_list<double> values) {
  Eigen::VectorXcd out(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) out[i++] = value;
  return out;
}

TEST(ModeShapes, MacIsTheCosineSquaredAndIgnoresFactors) {
  const Eigen::VectorXcd a = shape({1, 2, 2});
  EXPECT_NEAR(mac(a, shape({1, 2, 2}) * std::complex<double>(0.3, -2)), 1, 1e-15);
  EXPECT_NEAR(mac(a, shape({2, -2, 1})), 0, 1e-15);
  EXPECT_NEAR(mac(a, shape({1, 0, 0})), 1.0 / 9, 1e-15);
  EXPECT_TRUE(std::isnan(mac(a, shape({0, 0, 0}))));
  EXPECT_TRUE(std::isnan(mac(a, shape({1, 2}))));
}

TEST(ModeShapes, PairsByShapeAndFrequencyOneToOne) {
  const std::vector<ComparedMode> as{{1.0, shape({1, 2}), 0, 0}, {3.0, shape({2, -1}), 1, 1}};
  const std::vector<ComparedMode> bs{
      {3.1, shape({2.1, -1}), 0, 0}, {1.3, shape({1, 1.9}), 1, 1}, {1.02, shape({1, 2.1}), 2, 2}};
  EXPECT_EQ(paired_modes(as, bs), (std::vector<int>{2, 0}));
  // Neither a frequency half as large again nor another shape makes a pair.
  EXPECT_EQ(paired_modes({{1.0, shape({1, 2})}}, {{1.6, shape({1, 2})}}), std::vector<int>{-1});
  EXPECT_EQ(paired_modes({{1.0, shape({1, 2})}}, {{1.0, shape({2, -1})}}), std::vector<int>{-1});
}

TEST(ModeShapes, ChannelsBetweenFramesSeeTheirMean) {
  const Structure s = test::table1();
  std::vector<SensorAxis> axes(3);
  axes[0].direction = Direction::x;  // of the base: not compared
  axes[1].story = 2;
  axes[1].frame = 1;
  axes[2].story = 3;
  axes[2].plan = PlanPlace{0, s.span_y[0] / 4, 0};
  EXPECT_EQ(compared_axes(axes), (std::vector<std::size_t>{1, 2}));
  const Eigen::MatrixXd weights = channel_weights(s, axes);
  ASSERT_EQ(weights.rows(), 2);
  EXPECT_EQ(weights(0, s.dof(2, 1)), 1);
  EXPECT_NEAR(weights(1, s.dof(3, 0)), 0.75, 1e-12);
  EXPECT_NEAR(weights(1, s.dof(3, 1)), 0.25, 1e-12);
  EXPECT_NEAR(weights.cwiseAbs().sum(), 2, 1e-12);
}

}  // namespace mode_shapes_test
}  // namespace framewatch::estimator
