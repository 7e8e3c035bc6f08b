// SPDX-License-Identifier: MIT
#include "estimator/simulate/linear_response.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace linear_response_test {

PlanMotion sine(double frequency_hz, double duration_s) {
  GroundMotion motion{1e-3, {}};
  for (int i = 0; i <= 1000 * duration_s; ++i)
    motion.accel.push_back(std::sin(2 * M_PI * frequency_hz * 1e-3 * i));
  return {motion, {}};
}

double largest_base_x(const Response& response) {
  const Eigen::Index n = response.accel_abs.rows();
  return response.accel_abs.col(response.accel_abs.cols() - 2)
      .segment(n / 4, n / 2)
      .cwiseAbs()
      .maxCoeff();
}

TEST(LinearResponse, PassesTheUsableBandWithoutDelay) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  const Response r = linear_response(s, table, test::table1_theta(), sine(20, 4));
  ASSERT_EQ(r.accel_abs.rows(), 401);
  for (Eigen::Index i = 100; i < 300; ++i)
    ASSERT_NEAR(r.accel_abs(i, 20), std::sin(2 * M_PI * 20 * 0.01 * static_cast<double>(i)), 1e-3);
}

TEST(LinearResponse, DelaysAChannelByPartsOfAStep) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  for (const double delay_s : {0.0037, -0.0018, 0.025}) {
    ResponseStream stream(s, table, test::table1_theta(), sine(15, 4), {}, {},
                          {{20, delay_s}, {20, 0}});
    for (int i = 0; i < 300; ++i) {
      const Eigen::VectorXd& both = stream.next();
      if (i < 100) continue;
      const double t = stream.time_s();
      ASSERT_NEAR(both[0], std::sin(2 * M_PI * 15 * (t - delay_s)), 1e-3);
      ASSERT_NEAR(both[1], std::sin(2 * M_PI * 15 * t), 1e-3);
    }
  }
}

TEST(LinearResponse, FiltersFrequenciesThatWouldAlias) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  ResponseOptions without;
  without.anti_alias = false;
  EXPECT_LT(largest_base_x(linear_response(s, table, test::table1_theta(), sine(70, 4))), 2e-4);
  EXPECT_GT(largest_base_x(linear_response(s, table, test::table1_theta(), sine(70, 4), without)),
            0.5);
}

TEST(LinearResponse, FilteringChannelsEqualsFilteringTheGround) {
  const Structure s = test::table2();
  const ParameterTable table(s);
  const Eigen::VectorXd theta = test::table2_theta('c');
  PlanMotion motion = directed(kanai_tajimi({.duration_s = 4, .step_s = 1e-3}), M_PI / 4);
  const Response filtered = linear_response(s, table, theta, motion);
  // Filter the ground by the same low-pass first and leave its response unfiltered.
  const std::vector<double> taps = anti_alias_taps(10);
  const int half = static_cast<int>(taps.size() / 2);
  const auto low_passed = [&](const GroundMotion& in) {
    GroundMotion out = in;
    for (int i = 0; i < static_cast<int>(in.accel.size()); ++i) {
      double sum = 0;
      for (int j = -half; j <= half; ++j)
        sum += taps[static_cast<std::size_t>(j + half)] * in.at(1e-3 * (i - j) + 1e-12);
      out.accel[static_cast<std::size_t>(i)] = sum;
    }
    return out;
  };
  ResponseOptions plain;
  plain.anti_alias = false;
  const Response reference =
      linear_response(s, table, theta, {low_passed(motion.x), low_passed(motion.y)}, plain);
  const double scale = reference.accel_abs.cwiseAbs().maxCoeff();
  EXPECT_LT((filtered.accel_abs - reference.accel_abs).topRows(380).cwiseAbs().maxCoeff(),
            2e-3 * scale);
}

TEST(LinearResponse, AChangeActsFromItsTimeOn) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  const Eigen::VectorXd theta = test::table1_theta();
  Eigen::VectorXd weaker = theta;
  weaker[*table.find("kx_1_y1")] *= 0.8;
  const PlanMotion motion = directed(kanai_tajimi({.duration_s = 4}), 0.3);
  ResponseOptions options;
  options.anti_alias = false;
  ResponseStream a(s, table, theta, motion, options);
  ResponseStream b(s, table, theta, motion, options, {{2.0, weaker}});
  for (int i = 0; i <= 200; ++i) ASSERT_EQ(a.next(), b.next()) << i;
  double difference = 0;
  for (int i = 201; i <= 300; ++i)
    difference = std::max(difference, (a.next() - b.next()).cwiseAbs().maxCoeff());
  EXPECT_GT(difference, 0.01);
  EXPECT_DOUBLE_EQ(b.time_s(), 3.0);
}

TEST(LinearResponse, TheStepDoesNotMatterForLinearGroundMotion) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  const PlanMotion motion = directed(kanai_tajimi({.duration_s = 5, .step_s = 0.01}), 0.3);
  ResponseOptions fine, coarse;
  fine.anti_alias = coarse.anti_alias = false;
  fine.longest_step_s = 5e-4;
  coarse.longest_step_s = 1e-2;
  // The ground starts within the first step, so let it start at zero.
  PlanMotion from_zero = motion;
  from_zero.x.accel[0] = from_zero.y.accel[0] = 0;
  const Response a = linear_response(s, table, test::table1_theta(), from_zero, fine);
  const Response b = linear_response(s, table, test::table1_theta(), from_zero, coarse);
  EXPECT_LT((a.accel_abs - b.accel_abs).cwiseAbs().maxCoeff(),
            1e-11 * a.accel_abs.cwiseAbs().maxCoeff());
}

}  // namespace linear_response_test
}  // namespace framewatch::estimator
