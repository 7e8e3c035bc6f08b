// SPDX-License-Identifier: MIT
// A rocking base whose vertical channels show the rotation.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/diagnose/fit/diagnosis_input.h"
#include "estimator/diagnose/verdict/diagnose.h"
#include "estimator/identify/groups/floor_coordinates.h"
#include "estimator/simulate/building_model.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/group_design.h"
#include "tests/support/forced_building.h"

namespace framewatch::estimator {
namespace rocking_test {

using Eigen::Index;

constexpr double kExactStiffness = 2e-4, kUnknownStiffness = 0.02;
constexpr double kAlike = 0.005;  // the filters are tuned at another time
constexpr double kRate_hz = 100, kStep_s = 1e-3, kDuration_s = 40;
constexpr int kStories = 6;
constexpr double kWest_m = -3, kEast_m = 9;

SensorAxis vertical(const char* name, double x_m, double y_m) {
  SensorAxis out{name};
  out.vertical = true;
  out.plan = PlanPlace{x_m, y_m, 0};
  return out;
}

struct RockingRecord {
  PipelineConfig config;
  Eigen::VectorXd truth;    ///< in the order of config.parameters()
  Eigen::MatrixXd samples;  ///< instants x axes
};

/// A plane building with floors 3 and 6 measured, whose base shakes and rocks. Relative to a base
/// that turns rigidly by r, the floors feel -m h r'', which the simulation applies as a force of
/// that shape.
RockingRecord rocking_record(double noise_ratio) {
  RockingRecord out;
  PipelineConfig& c = out.config;
  c.structure = daemon::tall_building(kStories);
  c.design = daemon::tall_design(kStories);
  c.axes = daemon::floor_axes({3, 6});
  c.axes.push_back(vertical("west", kWest_m, 0));
  c.axes.push_back(vertical("east", kEast_m, 0));
  c.options.rate_hz = kRate_hz;
  Eigen::VectorXd theta = c.design;
  theta.segment(3, 3) *= 0.9;
  out.truth = group_parameters(c.structure, c.parameters(), {theta, {}});

  Eigen::VectorXd lever(kStories);
  for (int story = 1; story <= kStories; ++story)
    lever[story - 1] = -c.structure.frame_mass(story, 0) * c.structure.story_height[0] * story;
  Effect effect = make_effect(EffectKind::unmeasured_force, {});
  effect.set("rms_n", 0.03);  // rad/s^2
  effect.set("low_hz", 0.4);
  effect.set("high_hz", 8);
  const auto turned = [force = AppliedForce(effect)](double time_s) {
    return time_s > 0 ? force.at(time_s) : 0;
  };
  KanaiTajimi ground;
  ground.duration_s = kDuration_s + 1;
  ground.strong_s = kDuration_s;
  ground.step_s = kStep_s;
  ResponseOptions options;
  options.rate_hz = kRate_hz;
  // Shares of the forces -m h r'': a floor reads its motion and h r'', a vertical axis reads -x
  // r''.
  const auto force = [](int story) { return kStories + 2 + story - 1; };
  const auto floor = [&](int story) {
    return ResponseChannel{
        story - 1, 0, 1, {{force(story), -1 / c.structure.frame_mass(story, 0)}}};
  };
  ResponseStream response(
      std::make_unique<test::ForcedBuilding>(c.structure, theta, lever, turned, kStep_s),
      directed(kanai_tajimi(ground), 0), options, {},
      {{kStories},
       floor(3),
       floor(6),
       {force(1), 0, -kWest_m / lever[0]},
       {force(1), 0, -kEast_m / lever[0]}});
  out.samples.resize(static_cast<Index>(kDuration_s * kRate_hz), 5);
  for (Index i = 0; i < out.samples.rows(); ++i) out.samples.row(i) = response.next().transpose();
  Random random(5);
  for (Index a = 0; a < 5; ++a) {
    const double rms = std::sqrt(out.samples.col(a).array().square().mean());
    c.axes[static_cast<std::size_t>(a)].noise_density =
        std::max(noise_ratio, 1e-9) * rms / std::sqrt(kRate_hz / 2);
    for (double& value : out.samples.col(a)) value += noise_ratio * rms * random.normal();
  }
  return out;
}

double largest_error(const RockingRecord& record) {
  double out = 0;
  int windows = 0;
  for (const WindowEstimate& w : daemon::run_windows(record.config, record.samples, 20, 5)) {
    ++windows;
    for (std::size_t p = 0; p < 2; ++p)
      out = std::max(out, std::abs(w.solution[p] / record.truth[static_cast<Index>(p)] - 1));
  }
  return windows > 0 ? out : std::numeric_limits<double>::infinity();
}

/// Runs without the vertical axes.
RockingRecord unaware(RockingRecord record) {
  record.config.axes.resize(3);
  record.samples = record.samples.leftCols(3).eval();
  return record;
}

TEST(Rocking, IsAnInputIfMeasured) {
  const RockingRecord record = rocking_record(0);
  ASSERT_TRUE(problems(record.config).empty()) << problems(record.config).front();
  EXPECT_LT(largest_error(record), kExactStiffness);
  EXPECT_GT(largest_error(unaware(record)), kUnknownStiffness);
}

TEST(Rocking, IsTakenAsZeroIfAVerticalChannelDies) {
  RockingRecord record = rocking_record(0);
  record.samples.col(4).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NEAR(largest_error(record), largest_error(unaware(record)), kAlike);
}

TEST(Rocking, DrivesTheFreeRunOfADiagnosis) {
  const auto diagnosed = [](const RockingRecord& r) {
    const Index half = r.samples.rows() / 2;
    const auto input = diagnosis_input(
        r.config.structure, r.config.axes, r.config.design, {},
        {{kRate_hz, r.samples.topRows(half), 0}, {kRate_hz, r.samples.bottomRows(half), 0}});
    DiagnosisOptions options;
    options.holdout_from = 1;
    return diagnose(input->plant, input->segments, options);
  };
  const RockingRecord record = rocking_record(0.01);
  const Diagnosis with = diagnosed(record), without = diagnosed(unaware(record));
  EXPECT_EQ(with.verdict, Verdict::adequate);
  EXPECT_GT(without.before[1].overall, 5 * with.before[1].overall);
}

TEST(Rocking, IsThePlaneThroughTheVerticals) {
  constexpr double kRounding = 1e-12;
  const std::vector<std::uint8_t> all(4, 1);
  // A plane that rises toward -x and +y and lifts as a whole.
  std::vector<SensorAxis> axes{vertical("a", 0, 0), vertical("b", 10, 0), vertical("c", 10, 6),
                               vertical("d", 1, 5)};
  Eigen::VectorXd lifted(4);
  for (Index i = 0; i < 4; ++i) {
    const PlanPlace& place = *axes[static_cast<std::size_t>(i)].plan;
    lifted[i] = 0.7 - 2e-3 * place.x_m + 1e-3 * place.y_m;
  }
  auto rows = base_rotations(axes, all);
  ASSERT_EQ(rows[0].size(), 4);
  EXPECT_NEAR(rows[0] * lifted, 2e-3, kRounding);
  EXPECT_NEAR(rows[1] * lifted, -1e-3, kRounding);
  // Two axes along x show that direction alone; two across both directions show neither.
  rows = base_rotations(axes, {1, 1, 0, 0});
  EXPECT_NEAR(rows[0] * lifted, 2e-3, kRounding);
  EXPECT_EQ(rows[1].size(), 0);
  rows = base_rotations(axes, {1, 0, 1, 0});
  EXPECT_EQ(rows[0].size() + rows[1].size(), 0);
  EXPECT_EQ(base_rotations(axes, {1, 0, 0, 0})[0].size(), 0);
}

}  // namespace rocking_test
}  // namespace framewatch::estimator
