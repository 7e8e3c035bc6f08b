// SPDX-License-Identifier: MIT
// A building driven by a shaker or a hammer on a base that rests.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/few_sensors.h"
#include "estimator/pipeline/pipeline.h"
#include "estimator/simulate/building_model.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/story_groups.h"
#include "tests/support/forced_building.h"

namespace framewatch::estimator {
namespace force_test {

// Largest errors of stiffness and damping, exact and with 1 % noise on every channel.
constexpr double kExactStiffness = 1e-4, kExactDamping = 2e-3;
constexpr double kNoisyStiffness = 0.02, kNoisyDamping = 0.2;
constexpr double kNoise = 0.01, kStep_s = 1e-3, kRate_hz = 100, kDuration_s = 40;

using Force = std::function<double(double)>;

/// A shaker that excites all frequencies from 0.4 to 12 Hz.
Force shaker() {
  Effect effect = make_effect(EffectKind::unmeasured_force, {});
  effect.set("rms_n", 50e3);
  effect.set("low_hz", 0.4);
  effect.set("high_hz", 12);
  return
      [force = AppliedForce(effect)](double time_s) { return time_s > 0 ? force.at(time_s) : 0; };
}

/// Half sines of 40 ms.
Force hammer(double every_s) {
  return [every_s](double time_s) {
    constexpr double kPulse_s = 0.04;
    const double since_s = std::fmod(time_s, every_s);
    return time_s > 0 && since_s < kPulse_s ? 5e6 * std::sin(std::numbers::pi * since_s / kPulse_s)
                                            : 0.0;
  };
}

SensorAxis force_axis(int story, int frame) {
  SensorAxis axis;
  axis.name = "shaker";
  axis.story = story;
  axis.frame = frame;
  axis.is_force = true;
  return axis;
}

struct ForcedRecord {
  PipelineConfig config;
  Eigen::VectorXd truth;    ///< in the order of config.parameters()
  Eigen::MatrixXd samples;  ///< instants x axes
};

/// A plane building with channels on some floors and the force on one. Groups are off the design by
/// 10 %, alternating in sign.
ForcedRecord forced_record(int stories, const std::vector<int>& floors, int force_story,
                           const Force& force, double noise_ratio, const PlanMotion& ground = {}) {
  ForcedRecord out;
  PipelineConfig& c = out.config;
  c.structure = daemon::tall_building(stories);
  c.design = daemon::tall_design(stories);
  c.axes = daemon::floor_axes(floors);
  if (ground.duration_s() == 0) c.axes.erase(c.axes.begin());
  c.axes.push_back(force_axis(force_story, 0));
  c.options.rate_hz = kRate_hz;
  Eigen::VectorXd theta = c.design;
  int group = 0;
  for (int story = 1; story <= stories; ++story) {
    const double off = group % 2 == 0 ? 1.1 : 0.9;
    theta[story - 1] *= off;
    theta[stories + story - 1] *= 2 - off;
    if (group < static_cast<int>(floors.size()) && floors[static_cast<std::size_t>(group)] == story)
      ++group;
  }
  out.truth = group_parameters(c.structure, c.parameters(), {theta, {}});
  Eigen::VectorXd lever = Eigen::VectorXd::Zero(c.structure.degrees_of_freedom());
  lever[c.structure.dof(force_story, 0)] = 1;
  ResponseOptions options;
  options.rate_hz = kRate_hz;
  ResponseStream response(
      std::make_unique<test::ForcedBuilding>(c.structure, theta, lever, force, kStep_s), ground,
      options, {}, response_channels(c.structure, c.axes));
  out.samples.resize(static_cast<Eigen::Index>(kDuration_s * kRate_hz),
                     static_cast<Eigen::Index>(c.axes.size()));
  for (Eigen::Index i = 0; i < out.samples.rows(); ++i)
    out.samples.row(i) = response.next().transpose();
  Random random(7);
  for (std::size_t a = 0; a < c.axes.size(); ++a) {
    auto column = out.samples.col(static_cast<Eigen::Index>(a));
    const double rms = std::sqrt(column.array().square().mean());
    c.axes[a].noise_density = std::max(noise_ratio, 1e-9) * rms / std::sqrt(kRate_hz / 2);
    for (double& value : column) value += noise_ratio * rms * random.normal();
  }
  return out;
}

/// Returns the largest relative errors of the windows from `from_s` on.
struct Largest {
  double stiffness = 0, damping = 0;
  int windows = 0, published = 0;
};
Largest errors_of(const ForcedRecord& record, double from_s = 15) {
  Largest out;
  const ParameterTable table = record.config.parameters();
  for (const WindowEstimate& w : daemon::run_windows(record.config, record.samples, from_s, 5)) {
    ++out.windows;
    for (int p = 0; p < table.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      const double error = std::abs(w.solution[i] / record.truth[p] - 1);
      double& largest = table[p].kind == ParameterKind::frame_damping ? out.damping : out.stiffness;
      largest = std::max(largest, error);
      out.published += std::isfinite(w.value[i]);
    }
  }
  return out;
}

TEST(Force, IsExactOnAnUnmeasuredFloor) {
  const ForcedRecord record = forced_record(10, {3, 6, 10}, 5, shaker(), 0);
  ASSERT_EQ(record.config.parameters()[1].name, "kx_4to6");
  ASSERT_TRUE(problems(record.config).empty()) << problems(record.config).front();
  const Largest errors = errors_of(record);
  ASSERT_GE(errors.windows, 5);
  EXPECT_LT(errors.stiffness, kExactStiffness);
  EXPECT_LT(errors.damping, kExactDamping);
}

TEST(Force, IsExactIfEveryFloorIsMeasured) {
  const ForcedRecord record = forced_record(5, {1, 2, 3, 4, 5}, 5, shaker(), 0);
  ASSERT_EQ(record.config.parameters()[2].name, "kx_3_y1");
  const Largest errors = errors_of(record);
  EXPECT_LT(errors.stiffness, kExactStiffness);
  EXPECT_LT(errors.damping, kExactDamping);
}

TEST(Force, StaysWithinPercentsUnderNoise) {
  const Largest errors = errors_of(forced_record(10, {3, 6, 10}, 8, shaker(), kNoise));
  EXPECT_LT(errors.stiffness, kNoisyStiffness);
  EXPECT_LT(errors.damping, kNoisyDamping);
  EXPECT_GT(errors.published, 0);
}

TEST(Force, OfARareHammerBlowSuffices) {
  const ForcedRecord record = forced_record(5, {1, 2, 3, 4, 5}, 3, hammer(4), 0);
  const Largest errors = errors_of(record);
  EXPECT_LT(errors.stiffness, 10 * kExactStiffness);
  const Largest noisy = errors_of(forced_record(5, {1, 2, 3, 4, 5}, 3, hammer(4), kNoise));
  EXPECT_LT(noisy.stiffness, kNoisyStiffness);
  EXPECT_GT(noisy.published, 0);
}

TEST(Force, IsDistinguishedFromGroundMotion) {
  KanaiTajimi ground;
  ground.duration_s = kDuration_s + 1;
  ground.strong_s = kDuration_s;
  ground.step_s = kStep_s;
  const ForcedRecord record =
      forced_record(10, {3, 6, 10}, 5, shaker(), 0, directed(kanai_tajimi(ground), 0));
  const Largest errors = errors_of(record);
  EXPECT_LT(errors.stiffness, kExactStiffness);
  EXPECT_LT(errors.damping, kExactDamping);
}

TEST(Force, CausesErrorsIfLeftOut) {
  ForcedRecord record = forced_record(5, {1, 2, 3, 4, 5}, 3, shaker(), 0);
  record.samples.col(5).setZero();
  EXPECT_GT(errors_of(record).stiffness, 0.05) << "the shaker's cable was not plugged in";
}

TEST(Force, EndsEstimatesWhileItsChannelIsDead) {
  ForcedRecord record = forced_record(5, {1, 2, 3, 4, 5}, 3, shaker(), 0);
  const int from = 1800, to = 2600;
  record.samples.col(5)
      .segment(from, to - from)
      .setConstant(std::numeric_limits<double>::quiet_NaN());
  std::vector<WindowEstimate> windows;
  const auto take = [&](const WindowEstimate& e) {
    if (e.window == 0) windows.push_back(e);
  };
  Pipeline pipeline(record.config);
  for (Eigen::Index i = 0; i < record.samples.rows(); ++i)
    for (Eigen::Index a = 0; a < record.samples.cols(); ++a)
      if (std::isfinite(record.samples(i, a)))
        each_main_window(pipeline.push({from_microseconds(10'000 * i), static_cast<int>(a),
                                        record.samples(i, a)}),
                         take);
  each_main_window(pipeline.finish(), take);
  int before = 0, meanwhile = 0, after = 0;
  for (const WindowEstimate& w : windows) {
    const auto end = static_cast<int>(to_microseconds(w.end) / 10'000);
    const bool shown = std::isfinite(w.value[0]);
    if (end < from) before += shown;
    if (end > from + 600 && end < to) meanwhile += shown;
    if (end > to + 1000) after += shown;
    if (shown) {
      EXPECT_NEAR(w.value[0] / record.truth[0], 1, 0.01);
    }
  }
  EXPECT_GT(before, 0);
  EXPECT_EQ(meanwhile, 0);
  EXPECT_GT(after, 0);
}

/// Two frames each way, rigid floors, three channels per floor and an eccentric shaker.
TEST(Force, TurnsARigidFloorIfEccentric) {
  PipelineConfig c;
  Structure& s = c.structure;
  s.stories = 3;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2"};
  s.span_x = {12};
  s.span_y = {8};
  s.story_height.assign(3, 3.5);
  s.node_mass.assign(12, 20e3);
  s.floor = FloorModel::rigid;
  const ParameterTable stories(s);
  c.design = Eigen::VectorXd::Constant(stories.size(), 4e7);
  c.design.tail(stories.elements()).setConstant(1e5);
  Eigen::VectorXd theta = c.design;
  for (int p = 0; p < theta.size(); ++p) theta[p] *= 1 + 0.1 * std::sin(1.0 + p);
  for (int story = 1; story <= 3; ++story)
    for (const auto& [x_m, y_m, angle] :
         {std::tuple(6.0, 0.0, 0.0), std::tuple(6.0, 8.0, 0.0), std::tuple(0.0, 4.0, M_PI / 2)}) {
      SensorAxis axis;
      axis.name = "F" + std::to_string(c.axes.size());
      axis.story = story;
      axis.plan = PlanPlace{x_m, y_m, angle};
      axis.direction = angle == 0 ? Direction::x : Direction::y;
      axis.noise_density = 1e-7;
      c.axes.push_back(axis);
    }
  SensorAxis axis = force_axis(3, -1);
  axis.plan = PlanPlace{9, 1, 0.6};
  axis.noise_density = 1e-3;
  c.axes.push_back(axis);
  ASSERT_TRUE(problems(c).empty()) << problems(c).front();
  const std::vector<double> weights = frame_weights(s, axis);
  Eigen::VectorXd lever = Eigen::VectorXd::Zero(s.degrees_of_freedom());
  for (int f = 0; f < s.frames(); ++f) lever[s.dof(3, f)] = weights[static_cast<std::size_t>(f)];
  ResponseOptions options;
  options.rate_hz = kRate_hz;
  std::vector<ResponseChannel> channels = response_channels(s, c.axes);
  const Force force = shaker();
  // The simulated force channel holds all of the force: one over the first frame's share.
  channels.back() = {s.degrees_of_freedom() + 2 + s.dof(3, 0), 0, 1 / weights[0]};
  ResponseStream response(std::make_unique<test::ForcedBuilding>(s, theta, lever, force, kStep_s),
                          {}, options, {}, channels);
  Eigen::MatrixXd samples(static_cast<Eigen::Index>(kDuration_s * kRate_hz),
                          static_cast<Eigen::Index>(c.axes.size()));
  for (Eigen::Index i = 0; i < samples.rows(); ++i) samples.row(i) = response.next().transpose();
  const ParameterTable table = c.parameters();
  const Eigen::VectorXd truth = group_parameters(s, table, {theta, {}});
  double worst = 0;
  for (const WindowEstimate& w : daemon::run_windows(c, samples, 20, 5))
    for (int p = 0; p < table.elements(); ++p)
      worst = std::max(worst, std::abs(w.solution[static_cast<std::size_t>(p)] / truth[p] - 1));
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(worst, 0);
}

TEST(Force, IsRefusedOnTheBaseOrAlone) {
  ForcedRecord record = forced_record(5, {1, 3, 5}, 3, shaker(), 0);
  PipelineConfig base = record.config;
  base.axes.back().story = 0;
  ASSERT_EQ(problems(base).size(), 1U);
  EXPECT_NE(problems(base)[0].find("a force on the base moves nothing"), std::string::npos);
  PipelineConfig alone = record.config;
  alone.axes.erase(alone.axes.begin(), alone.axes.end() - 1);
  ASSERT_EQ(problems(alone).size(), 1U);
  EXPECT_NE(problems(alone)[0].find("no channel above the base"), std::string::npos);
  PipelineConfig no_force = record.config;
  no_force.axes.pop_back();
  ASSERT_EQ(problems(no_force).size(), 1U);
  EXPECT_NE(problems(no_force)[0].find("base channel"), std::string::npos);
}

}  // namespace force_test
}  // namespace framewatch::estimator
