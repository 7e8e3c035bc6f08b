// SPDX-License-Identifier: MIT
// Inputs beyond the base's translations: a base that turns or rocks, and a shaker.
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/gap/gap_monitor.h"
#include "estimator/simulate/building_model.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/nonlinear_building.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/forced_building.h"

namespace framewatch::estimator {
namespace measured_inputs_test {

constexpr double kRate_hz = 100, kStep_s = 1e-3, kSeconds = 60;
constexpr double kSchemeError = 1e-3, kUnaware = 0.1, kFloorOff = 0.15;
constexpr double kWide_m = 6, kDeep_m = 8, kHeight_m = 3;

Structure building() {
  Structure s;
  s.name = "two by two";
  s.stories = 2;
  s.frames_x = {"x1", "x2"};
  s.frames_y = {"y1", "y2"};
  s.span_x = {kWide_m};
  s.span_y = {kDeep_m};
  s.story_height = {kHeight_m, kHeight_m};
  s.node_mass = {10, 12, 9, 10, 8, 11, 10, 9};
  return s;
}

SensorAxis axis(const std::string& name, int story, int frame) {
  SensorAxis out;
  out.name = name;
  out.story = story;
  out.frame = frame;
  return out;
}

SensorAxis at_base(const std::string& name, double x_m, double y_m, double angle_rad) {
  SensorAxis out;
  out.name = name;
  out.direction = angle_rad == 0 ? Direction::x : Direction::y;
  out.plan = PlanPlace{x_m, y_m, angle_rad};
  return out;
}

/// A building moved by the ground along x and by one more input.
class MeasuredInput : public testing::Test {
 protected:
  MeasuredInput() : structure_(building()), table_(structure_) {
    theta_ = Eigen::VectorXd::Constant(table_.size(), 14e3);
    theta_.segment(0, 4) << 14e3, 16e3, 13e3, 15e3;
    theta_ = with_proportional_damping(structure_, table_, theta_, 0.02);
    for (int story = 1; story <= 2; ++story)
      for (int f = 0; f < structure_.frames(); ++f)
        add(axis("F" + std::to_string(story) + structure_.frame_name(f), story, f),
            {structure_.dof(story, f)});
  }

  void add(const SensorAxis& axis, const ResponseChannel& channel) {
    axes_.push_back(axis);
    channels_.push_back(channel);
  }
  int ground_x() const { return structure_.degrees_of_freedom(); }
  int force_at(int dof) const { return structure_.degrees_of_freedom() + 2 + dof; }

  /// Turns the ground: `influence` is the motion of the degrees of freedom per rad. Relative to
  /// that it is a force; the channels so far become absolute.
  void turn(const Eigen::VectorXd& influence) {
    lever_ = Eigen::VectorXd::Zero(influence.size());
    for (int story = 1; story <= 2; ++story)
      for (int f = 0; f < structure_.frames(); ++f) {
        const int dof = structure_.dof(story, f);
        lever_[dof] = -structure_.frame_mass(story, f) * influence[dof];
      }
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const int dof = channels_[c].column;
      if (influence[dof] != 0)
        channels_[c].also.emplace_back(force_at(dof), influence[dof] / lever_[dof]);
    }
  }
  /// Adds a share of the turning acceleration.
  std::pair<int, double> turning(double per_rad) const {
    Eigen::Index at = 0;
    lever_.cwiseAbs().maxCoeff(&at);
    return {force_at(static_cast<int>(at)), per_rad / lever_[at]};
  }

  std::vector<SampleSet> measured(double strength, double noise) const {
    Effect effect = make_effect(EffectKind::unmeasured_force, {});
    effect.set("rms_n", strength);
    effect.set("low_hz", 0.5);
    effect.set("high_hz", 10);
    const auto input = [force = AppliedForce(effect)](double time_s) {
      return time_s > 0 ? force.at(time_s) : 0;
    };
    KanaiTajimi ground;
    ground.duration_s = kSeconds + 1, ground.strong_s = kSeconds, ground.step_s = kStep_s;
    ResponseOptions options;
    options.rate_hz = kRate_hz;
    ResponseStream stream(
        std::make_unique<test::ForcedBuilding>(structure_, theta_, lever_, input, kStep_s),
        directed(kanai_tajimi(ground), 0), options, {}, channels_);
    Random random(3);
    std::vector<SampleSet> out;
    for (int i = 0; i < kSeconds * kRate_hz; ++i) {
      const Eigen::VectorXd& a = stream.next();
      SampleSet set{from_microseconds(10'000LL * i), i, {a.begin(), a.end()}};
      for (double& value : set.accel) value += noise * std::sqrt(kRate_hz / 2) * random.normal();
      out.push_back(set);
    }
    return out;
  }

  GapWindow last(const std::vector<SampleSet>& sets, std::vector<SensorAxis> axes, double noise,
                 const std::vector<Effect>& effects = {}) const {
    PipelineConfig config;
    config.structure = structure_;
    config.axes = axes;
    GapMonitor monitor(config, axes, {}, GapModel{theta_, effects});
    const std::vector<double> density(axes.size(), noise);
    GapWindow out;
    for (const SampleSet& set : sets)
      if (const GapWindow* w = monitor.push(set, density)) out = *w;
    return out;
  }
  /// Uses these axes for checks alone.
  std::vector<SensorAxis> unaware(std::size_t from) const {
    std::vector<SensorAxis> out = axes_;
    for (std::size_t a = from; a < out.size(); ++a) out[a].check = true;
    return out;
  }

  /// A base that turns about the vertical, measured by two axes along x and one along y.
  void turn_in_plan() {
    Eigen::VectorXd influence(structure_.degrees_of_freedom());
    influence << kDeep_m / 2, -kDeep_m / 2, -kWide_m / 2, kWide_m / 2, kDeep_m / 2, -kDeep_m / 2,
        -kWide_m / 2, kWide_m / 2;
    turn(influence);
    add(at_base("X south", 0, 0, 0), {ground_x(), 0, 1, {turning(kDeep_m / 2)}});
    add(at_base("Y east", kWide_m, 0, M_PI / 2), {ground_x(), 0, 0, {turning(kWide_m / 2)}});
    add(at_base("X north", 2, kDeep_m, 0), {ground_x(), 0, 1, {turning(-kDeep_m / 2)}});
  }

  Structure structure_;
  ParameterTable table_;
  Eigen::VectorXd theta_, lever_;
  std::vector<SensorAxis> axes_;
  std::vector<ResponseChannel> channels_;
};

TEST_F(MeasuredInput, ATurningBaseGivesNoGap) {
  turn_in_plan();
  const auto sets = measured(0.05, 0);
  EXPECT_LT(last(sets, axes_, 0).nrmse, kSchemeError);
  EXPECT_GT(last(sets, unaware(axes_.size() - 1), 0).nrmse, kUnaware);
}

/// An effect of size 0 selects the nonlinear scheme.
TEST_F(MeasuredInput, DrivesTheNonlinearSchemeToo) {
  turn_in_plan();
  Effect none = make_effect(EffectKind::cubic_stiffness, {PlaceKind::frame, 1, 0});
  none.set("k3_npm3", 0);
  EXPECT_LT(last(measured(0.05, 0), axes_, 0, {none}).nrmse, kSchemeError);
}

TEST_F(MeasuredInput, ARockingBaseGivesNoGap) {
  Eigen::VectorXd influence(structure_.degrees_of_freedom());
  influence << kHeight_m, kHeight_m, 0, 0, 2 * kHeight_m, 2 * kHeight_m, 0, 0;
  turn(influence);
  add(at_base("X", kWide_m / 2, kDeep_m / 2, 0), {ground_x()});
  add(at_base("Y", kWide_m / 2, kDeep_m / 2, M_PI / 2), {ground_x() + 1});
  for (const double x_m : {-1.0, 7.0}) {
    SensorAxis up = at_base("Z" + std::to_string(x_m), x_m, 1, 0);
    up.vertical = true;
    add(up, {ground_x(), 0, 0, {turning(-x_m)}});
  }
  const auto sets = measured(0.05, 0);
  EXPECT_LT(last(sets, axes_, 0).nrmse, kSchemeError);
  EXPECT_GT(last(sets, unaware(axes_.size() - 2), 0).nrmse, kUnaware);
}

TEST_F(MeasuredInput, AShakerGivesNoGap) {
  lever_ = Eigen::VectorXd::Zero(structure_.degrees_of_freedom());
  lever_[structure_.dof(2, 1)] = 1;
  add(at_base("X", kWide_m / 2, kDeep_m / 2, 0), {ground_x()});
  add(at_base("Y", kWide_m / 2, kDeep_m / 2, M_PI / 2), {ground_x() + 1});
  SensorAxis shaker = axis("shaker", 2, 1);
  shaker.is_force = true;
  add(shaker, {force_at(structure_.dof(2, 1))});
  const auto sets = measured(30, 0);
  const GapWindow gap = last(sets, axes_, 0);
  EXPECT_LT(gap.nrmse, kSchemeError);
  EXPECT_TRUE(std::isnan(gap.axis_nrmse.back()));
  EXPECT_GT(last(sets, unaware(axes_.size() - 1), 0).nrmse, kUnaware);
}

/// One of the base's axes fails: the others still measure its directions but not how it turns.
TEST_F(MeasuredInput, ALostAxisIsReplacedByOthersOfItsDirection) {
  constexpr std::size_t kFails = 2000;
  turn_in_plan();
  std::vector<SampleSet> sets = measured(1e-4, 0), blind = sets;
  for (std::size_t i = kFails; i < sets.size(); ++i) {
    sets[i].accel.back() = NAN;
    blind[i].accel[axes_.size() - 2] = NAN;  // the only one along y
  }
  const GapWindow gap = last(sets, axes_, 0);
  EXPECT_GT(gap.end, sets[kFails + 2000].time);
  EXPECT_LT(gap.nrmse, kUnaware);
  EXPECT_LT(last(blind, axes_, 0).end, blind[kFails].time);
}

TEST_F(MeasuredInput, NoiseMatchesTheNoiseFloor) {
  constexpr double kNoise = 5e-3;
  turn_in_plan();
  const GapWindow gap = last(measured(0.05, kNoise), axes_, kNoise);
  EXPECT_NEAR(gap.nrmse / gap.floor, 1, kFloorOff);
}

}  // namespace measured_inputs_test
}  // namespace framewatch::estimator
