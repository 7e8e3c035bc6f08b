// SPDX-License-Identifier: MIT
#include "estimator/shaking/left_out_floor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "daemon/tools/lab/few_sensors.h"

namespace framewatch::estimator {
namespace left_out_floor_test {

using daemon::tall_record;
using daemon::TallRecord;
using daemon::TallTrial;

constexpr Eigen::Index kFirst = 1000, kEnd = 3000;

TallTrial exact(double damping_off = 0) {
  TallTrial trial;
  trial.noise_ratio = 0;
  trial.stiffness_off = trial.damping_off = damping_off;
  trial.duration_s = 40;
  return trial;
}

TEST(LeftOutFloor, IsPredictedByTheRightModel) {
  constexpr double kLow = 2e-3, kAll = 0.02;
  const TallRecord record = tall_record(exact());
  const auto floors = leave_floors_out(record.config, record.truth, record.accel, kFirst, kEnd);
  ASSERT_EQ(floors.size(), 3u);
  for (std::size_t i = 0; i < floors.size(); ++i) {
    EXPECT_EQ(floors[i].floor, 5 * (static_cast<int>(i) + 1));
    EXPECT_EQ(floors[i].direction, Direction::x);
    EXPECT_LT(floors[i].low_error, kLow) << floors[i].floor;
    EXPECT_LT(floors[i].error, kAll) << floors[i].floor;
    EXPECT_GT(floors[i].low_spline, 20 * floors[i].low_error);
  }
}

TEST(LeftOutFloor, IsNearlyPredictedIfGroupsDifferInDamping) {
  constexpr double kLow = 0.05;  // inner modes ignore damping that is not proportional
  const TallRecord record = tall_record(exact(0.3));
  for (const LeftOutFloor& floor :
       leave_floors_out(record.config, record.truth, record.accel, kFirst, kEnd))
    EXPECT_LT(floor.low_error, kLow) << floor.floor;
}

TEST(LeftOutFloor, ShowsAWrongModel) {
  const TallRecord record = tall_record(exact());
  const Eigen::VectorXd half = 0.5 * record.truth;
  const auto floors = leave_floors_out(record.config, half, record.accel, kFirst, kEnd);
  for (const LeftOutFloor& floor : floors) EXPECT_GT(floor.low_error, 0.05) << floor.floor;
}

TEST(LeftOutFloor, IgnoresMissingSamples) {
  TallRecord record = tall_record(exact());
  record.accel(1500, 2) = kNaN;
  const auto floors = leave_floors_out(record.config, record.truth, record.accel, kFirst, kEnd);
  EXPECT_TRUE(std::isnan(floors[1].error));
  record.accel.setZero();
  for (const LeftOutFloor& floor :
       leave_floors_out(record.config, record.truth, record.accel, kFirst, kEnd))
    EXPECT_TRUE(std::isnan(floor.error));
}

TEST(SplineWeights, InterpolatePlacesAndStraightLines) {
  constexpr double kLimit = 1e-12;
  const std::vector<double> places{0, 1, 4, 6};
  const Eigen::Vector4d line(2, 5, 14, 20);
  EXPECT_NEAR(spline_weights(places, 4).dot(line), 14, kLimit);
  for (const double at : {0.5, 3.0, 5.5, 7.0})
    EXPECT_NEAR(spline_weights(places, at).sum(), 1, kLimit);
  for (const double at : {0.5, 3.0, 5.5})
    EXPECT_NEAR(spline_weights(places, at).dot(line), 2 + 3 * at, kLimit);
  // a natural spline through 0, 1, 0 is 11/16 half way up
  EXPECT_NEAR(spline_weights({0, 1, 2}, 0.5).dot(Eigen::Vector3d(0, 1, 0)), 0.6875, kLimit);
}

}  // namespace left_out_floor_test
}  // namespace framewatch::estimator
