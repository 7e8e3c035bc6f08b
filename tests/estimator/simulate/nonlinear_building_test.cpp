// SPDX-License-Identifier: MIT
#include "estimator/simulate/nonlinear_building.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/linear_building.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/example_effects.h"

namespace framewatch::estimator {
namespace nonlinear_building_test {

/// Tolerance as a share of the response's peak.
constexpr double kExact = 1e-9;
/// Largest change of the response when the step is halved: smooth laws, and laws with kinks.
constexpr double kSmooth = 1e-7;
constexpr double kCorners = 3e-5;
/// Returns an effect of size 0 or, if 0 is not allowed, a tiny one.
constexpr double kNoEffect = 1e-6;
constexpr double kStep_s = 1e-3;
constexpr int kSteps = 4000;

PlanMotion shaking() {
  KanaiTajimi p;
  p.ground_frequency_hz = 4;
  p.peak_mps2 = 3;
  p.duration_s = 8;
  p.build_up_s = 0.5;
  p.strong_s = 6;
  p.seed = 11;
  return directed(kanai_tajimi(p), 0.6);
}

/// Absolute accelerations, a column per step.
Eigen::MatrixXd shake(SimulatedBuilding& building, const PlanMotion& motion = shaking()) {
  Eigen::MatrixXd out(building.accel_abs().size(), kSteps);
  const auto ground = [&](int step) {
    const double t = step * kStep_s;
    return Eigen::Vector2d(motion.x.at(t), motion.y.at(t));
  };
  for (int i = 0; i < kSteps; ++i) {
    building.advance(ground(i), ground(i + 1));
    out.col(i) = building.accel_abs();
  }
  return out;
}

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

Eigen::MatrixXd shake_with(const test::TableModel& m, const std::vector<Effect>& effects,
                           int refinement = 1) {
  NonlinearBuilding building(m.structure, m.table(), m.theta, effects, kStep_s, refinement);
  return shake(building);
}

Eigen::MatrixXd shake_linear(const test::TableModel& m) {
  LinearBuilding building(m.structure, m.table(), m.theta, kStep_s);
  return shake(building);
}

std::vector<EffectKind> building_kinds() {
  std::vector<EffectKind> out;
  for (const EffectDescription& d : effect_catalogue())
    if (!is_channel_effect(d.kind)) out.push_back(d.kind);
  return out;
}

test::TableModel model_for(EffectKind kind) {
  return test::table_model(kind == EffectKind::floor_flexibility ? FloorModel::rigid
                                                                 : FloorModel::flexible);
}

class EveryEffect : public testing::TestWithParam<EffectKind> {};

TEST_P(EveryEffect, GivesTheLinearBuildingAtSizeZero) {
  const test::TableModel m = model_for(GetParam());
  const Effect none = test::example_effect(GetParam(), m, 0);
  EXPECT_LT(difference(shake_with(m, {none}), shake_linear(m)), kNoEffect);
}

TEST_P(EveryEffect, ChangesTheResponse) {
  const test::TableModel m = model_for(GetParam());
  const double change =
      difference(shake_with(m, {test::example_effect(GetParam(), m)}), shake_linear(m));
  EXPECT_GT(change, 0.01);
  EXPECT_LT(change, 3);
}

TEST_P(EveryEffect, ConvergesWithTheStep) {
  const test::TableModel m = model_for(GetParam());
  const std::vector<Effect> effects{test::example_effect(GetParam(), m)};
  const Eigen::MatrixXd fine = shake_with(m, effects, 4);
  const double coarse = difference(shake_with(m, effects, 1), fine);
  const double medium = difference(shake_with(m, effects, 2), fine);
  using enum EffectKind;
  const bool corners = GetParam() == bilinear_hysteresis || GetParam() == one_sided_gap ||
                       GetParam() == two_sided_gap || GetParam() == bouc_wen ||
                       GetParam() == pinching || GetParam() == coulomb_friction ||
                       GetParam() == quadratic_damping || GetParam() == quadratic_stiffness ||
                       GetParam() == amplitude_dependence;
  EXPECT_LT(coarse, corners ? kCorners : kSmooth);
  EXPECT_LE(medium, std::max(coarse, kExact));
  RecordProperty("coarse", std::to_string(coarse));
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, testing::ValuesIn(building_kinds()),
                         [](const auto& p) { return std::string(name_of(p.param)); });

TEST(NonlinearBuilding, WithoutEffectsIsTheLinearBuilding) {
  for (const FloorModel floor : {FloorModel::flexible, FloorModel::rigid}) {
    const test::TableModel m = test::table_model(floor);
    EXPECT_LT(difference(shake_with(m, {}), shake_linear(m)), kExact);
  }
}

/// One story, one frame.
Structure one_mass(double mass = 2) {
  Structure s;
  s.stories = 1;
  s.frames_x = {"y1"};
  s.story_height = {1.5};
  s.node_mass = {mass};
  return s;
}

Effect on_first_frame(EffectKind kind, std::initializer_list<double> values) {
  EffectPlace place;
  place.kind = describe(kind).places.front();
  if (place.kind != PlaceKind::building) {
    place.story = 1;
    place.frame = 0;
  }
  Effect out = make_effect(kind, place);
  std::copy(values.begin(), values.end(), out.values.begin());
  return out;
}

Eigen::VectorXd pair_of(double k, double c) {
  return Eigen::Vector2d(k, c);
}

/// Integrates m x'' + c x' + k x + f(x, v, z) = 0, z' = rate(v, z) by classic Runge-Kutta with tiny
/// steps.
template <class Force, class Rate>
double free_vibration(double k, double c, double m, double x, double seconds, Force force,
                      Rate rate) {
  using State = Eigen::Vector3d;
  const int steps = 400000;
  const double h = seconds / steps;
  const auto slope = [&](const State& s) {
    return State(s[1], -(c * s[1] + k * s[0] + force(s[0], s[1], s[2])) / m, rate(s[1], s[2]));
  };
  State s(x, 0, 0);
  for (int i = 0; i < steps; ++i) {
    const State k1 = slope(s), k2 = slope(s + h / 2 * k1), k3 = slope(s + h / 2 * k2),
                k4 = slope(s + h * k3);
    s += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return s[0];
}

double simulated(const Effect& effect, double x, double seconds) {
  const Structure s = one_mass();
  NonlinearBuilding b(s, ParameterTable(s), pair_of(800, 2), {effect}, kStep_s);
  b.set_state(Eigen::VectorXd::Constant(1, x), Eigen::VectorXd::Zero(1));
  for (int i = 0; i < static_cast<int>(seconds / kStep_s); ++i) b.advance({0, 0}, {0, 0});
  return b.disp_rel()[0];
}

TEST(NonlinearBuilding, AgreesWithAnotherScheme) {
  const auto no_rate = [](double, double) { return 0.0; };
  const double x = 0.02, seconds = 3;
  EXPECT_NEAR(
      simulated(on_first_frame(EffectKind::cubic_stiffness, {1e6}), x, seconds),
      free_vibration(
          800, 2, 2, x, seconds, [](double d, double, double) { return 1e6 * d * d * d; }, no_rate),
      1e-8 * x);
  EXPECT_NEAR(simulated(on_first_frame(EffectKind::quadratic_damping, {50}), x, seconds),
              free_vibration(
                  800, 2, 2, x, seconds,
                  [](double, double v, double) { return 50 * v * std::abs(v); }, no_rate),
              1e-6 * x);
  EXPECT_NEAR(simulated(on_first_frame(EffectKind::bouc_wen, {400, 0.005, 2, 0.7}), x, seconds),
              free_vibration(
                  800, 2, 2, x, seconds, [](double, double, double z) { return 400 * z; },
                  [](double v, double z) {
                    const double sign = v * z > 0 ? 1 : v * z < 0 ? -1 : 0;
                    return v * (1 - z * z / 2.5e-5 * (0.7 * sign + 0.3));
                  }),
              1e-5 * x);
  EXPECT_NEAR(simulated(on_first_frame(EffectKind::two_sided_gap, {3000, 0.01}), x, seconds),
              free_vibration(
                  800, 2, 2, x, seconds,
                  [](double d, double, double) {
                    return 3000 * (std::max(d - 0.01, 0.0) - std::max(-d - 0.01, 0.0));
                  },
                  no_rate),
              1e-4 * x);
}

TEST(NonlinearBuilding, TunedMassDamperIsASecondStory) {
  const Structure one = one_mass();
  const double mass = 0.3, hz = 2.5, ratio = 0.08, w = 2 * M_PI * hz;
  NonlinearBuilding damped(one, ParameterTable(one), pair_of(800, 2),
                           {on_first_frame(EffectKind::tuned_mass_damper, {mass, hz, ratio})},
                           kStep_s);
  Structure two = one;
  two.stories = 2;
  two.story_height = {1, 1};
  two.node_mass = {2, mass};
  LinearBuilding both(two, ParameterTable(two),
                      Eigen::Vector4d(800, mass * w * w, 2, 2 * ratio * mass * w), kStep_s);
  EXPECT_LT(difference(shake(damped), shake(both).topRows(1)), kExact);
}

TEST(NonlinearBuilding, RotationalSpringsActInSeries) {
  const Structure s = one_mass();
  const double k = 800, turning = 3000, h = 1.5;
  const double series = 1 / (1 / k + h * h / turning);
  const double share = series / k;  // the frame's share of the drift
  LinearBuilding softer(s, ParameterTable(s), pair_of(series, 2 * share * share), kStep_s);
  const Eigen::MatrixXd expected = shake(softer);
  for (const EffectKind kind : {EffectKind::base_rocking, EffectKind::frame_bending}) {
    NonlinearBuilding b(s, ParameterTable(s), pair_of(k, 2), {on_first_frame(kind, {turning})},
                        kStep_s);
    EXPECT_LT(difference(shake(b), expected), kExact);
  }
}

TEST(NonlinearBuilding, FlexibleFloorsMatchAFlexibleBuilding) {
  const test::TableModel rigid = test::table_model(FloorModel::rigid);
  const test::TableModel flexible = test::table_model();
  const ParameterTable table = flexible.table();
  std::vector<Effect> effects;
  for (const EffectPlace& place :
       effect_places(EffectKind::floor_flexibility, rigid.structure, rigid.axes))
    effects.push_back({EffectKind::floor_flexibility,
                       place,
                       {flexible.theta[table.panel_stiffness(place.story, 0)],
                        flexible.theta[table.panel_damping(place.story, 0)]}});
  Eigen::VectorXd theta(rigid.table().size());
  theta << flexible.theta.head(8), flexible.theta.segment(10, 8);
  NonlinearBuilding b(rigid.structure, rigid.table(), theta, effects, kStep_s);
  EXPECT_LT(difference(shake(b), shake_linear(flexible)), kExact);
}

TEST(NonlinearBuilding, ExtraMassAddsToTheNode) {
  test::TableModel m = test::table_model();
  const Eigen::MatrixXd with_effect =
      shake_with(m, {test::example_effect(EffectKind::extra_mass, m)});
  m.structure.node_mass[0] += 3;
  EXPECT_LT(difference(with_effect, shake_linear(m)), kExact);
}

TEST(NonlinearBuilding, StiffnessDropsAtItsTime) {
  const test::TableModel m = test::table_model();
  const Effect drop = test::example_effect(EffectKind::stiffness_drop, m);
  LinearBuilding b(m.structure, m.table(), m.theta, kStep_s);
  Eigen::VectorXd weaker = m.theta;
  weaker[m.table().frame_stiffness(1, 0)] += drop.value("dk_npm");
  const PlanMotion motion = shaking();
  const Eigen::MatrixXd dropped = shake_with(m, {drop});
  for (int i = 0; i < kSteps; ++i) {
    if (i == 2000) b.set_theta(weaker);
    const double t = i * kStep_s;
    b.advance({motion.x.at(t), motion.y.at(t)},
              {motion.x.at(t + kStep_s), motion.y.at(t + kStep_s)});
    ASSERT_LT((b.accel_abs() - dropped.col(i)).cwiseAbs().maxCoeff(), 1e-6) << "step " << i;
  }
}

TEST(NonlinearBuilding, MassDampingFallsWithFrequency) {
  constexpr double kAlpha_ps = 0.7;
  const test::TableModel m = test::table_model();
  const Structure& s = m.structure;
  std::vector<Effect> ratios, dampers;
  for (const EffectPlace& place : effect_places(EffectKind::modal_damping, s, m.axes)) {
    const double hz =
        natural_frequencies_hz(s, m.table(), m.theta)[static_cast<std::size_t>(place.mode - 1)];
    ratios.push_back(make_effect(EffectKind::modal_damping, place));
    ratios.back().set("damping_ratio", kAlpha_ps / (4 * M_PI * hz));
  }
  for (const EffectPlace& place : effect_places(EffectKind::added_damper, s, m.axes)) {
    dampers.push_back(make_effect(EffectKind::added_damper, place));
    dampers.back().set("c_nspm", kAlpha_ps * s.frame_mass(place.story, place.frame));
  }
  test::TableModel damped = m;  // floor 1 has its dashpots to the ground within its frames
  for (int f = 0; f < s.frames(); ++f)
    damped.theta[m.table().frame_damping(1, f)] += kAlpha_ps * s.frame_mass(1, f);
  const Eigen::MatrixXd by_ratios = shake_with(m, ratios);
  EXPECT_LT(difference(by_ratios, shake_with(damped, dampers)), kExact);
  EXPECT_GT(difference(by_ratios, shake_with(m, {})), 0.05);
}

TEST(NonlinearBuilding, AHarmonicForceGivesTheClosedForm) {
  const Structure s = one_mass();
  const double k = 800, c = 8, hz = 2, force = 5, w = 2 * M_PI * hz;
  NonlinearBuilding b(
      s, ParameterTable(s), pair_of(k, c),
      {on_first_frame(EffectKind::unmeasured_force, {force, hz, 0, 0, 0.1, 1, 1, 0})}, kStep_s);
  double peak = 0, at_start = 0;
  for (int i = 0; i < 20000; ++i) {
    b.advance({0, 0}, {0, 0});
    if (i == 10) at_start = b.accel_abs()[0];
    if (i > 18000) peak = std::max(peak, std::abs(b.disp_rel()[0]));
  }
  EXPECT_GT(at_start, 0) << "pushes toward positive first";
  EXPECT_NEAR(peak, force / std::hypot(k - 2 * w * w, c * w), 1e-4 * peak);
}

std::vector<Effect> effects_with_memory(const test::TableModel& m) {
  using enum EffectKind;
  std::vector<Effect> out{test::example_effect(bouc_wen, m), test::example_effect(pinching, m)};
  out.back().set("slack", 1);
  for (const char* key : {"spread", "sharpness", "peak_oriented"}) {
    out.push_back(test::example_effect(bilinear_hysteresis, m));
    out.back().set(key, 1);
  }
  out.push_back(test::example_effect(bilinear_hysteresis, m));
  return out;
}

TEST(NonlinearBuilding, ContinuesFromItsMotionBitByBit) {
  const test::TableModel m = test::table_model();
  for (const Effect& effect : effects_with_memory(m)) {
    NonlinearBuilding whole(m.structure, m.table(), m.theta, {effect}, kStep_s);
    const std::vector<double> rest = whole.motion();
    const Eigen::MatrixXd first = shake(whole);
    NonlinearBuilding resumed(m.structure, m.table(), m.theta, {effect}, kStep_s);
    ASSERT_TRUE(resumed.resume(whole.motion())) << name_of(effect.kind);
    EXPECT_EQ(shake(resumed), shake(whole)) << name_of(effect.kind);
    EXPECT_FALSE(resumed.resume({1, 2, 3}));
    ASSERT_TRUE(resumed.resume(rest));
    EXPECT_EQ(shake(resumed), first) << name_of(effect.kind) << " from rest";
  }
}

TEST(BuildingModel, DetectsAnUnstableBuilding) {
  const test::TableModel m = test::table_model();
  Effect heavy = test::example_effect(EffectKind::p_delta, m);
  EXPECT_TRUE(stands(m.structure, m.table(), m.theta, {heavy}));
  heavy.set("weight_n", 1e6);
  EXPECT_FALSE(stands(m.structure, m.table(), m.theta, {heavy}));
  Effect lost = test::example_effect(EffectKind::stiffness_drop, m);
  lost.set("dk_npm", -1e6);
  EXPECT_FALSE(stands(m.structure, m.table(), m.theta, {lost}));
}

}  // namespace nonlinear_building_test
}  // namespace framewatch::estimator
