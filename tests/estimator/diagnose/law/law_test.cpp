// SPDX-License-Identifier: MIT
#include "estimator/diagnose/law/law.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "estimator/simulate/make_law.h"
#include "tests/estimator/diagnose/effect_of.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace law_test {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kRounding = 1e-12;
constexpr double kStiffness = 4e6, kYields_m = 2e-3;  // of the hysteretic laws

TEST(Law, ForcesMatchTheFormulas) {
  struct Case {
    LawValues law;
    double d, v, t, force;
  };
  const LawValues cubic{LawForm::power, {2, 3}, 0.5, 1};
  const LawValues root{LawForm::power, {3, 0.5}, 1, 1};
  const LawValues friction{LawForm::friction, {5, 0.1}, 1, 1};
  const LawValues square_rate{LawForm::power_damping, {3, 2}, 1, 0.5};
  const LawValues drift{LawForm::changing, {-10, 2, 4}, 1, 1};
  const auto gap = [](LawForm form) { return LawValues{form, {100, 0.02}, 1, 1}; };
  const Case cases[] = {
      {cubic, 0.25, 9, 9, 0.25},
      {cubic, -0.5, 9, 9, -2},
      {root, 0.16, 0, 0, 1.2},
      {root, -0.16, 0, 0, -1.2},
      {friction, 7, 0.2, 0, 5 * std::tanh(2.0)},
      {friction, 7, -5, 0, -5},
      {square_rate, 7, 1, 0, 12},
      {square_rate, 7, -0.25, 0, -0.75},
      {gap(LawForm::gap_positive), 0.05, 0, 0, 3},
      {gap(LawForm::gap_positive), 0.01, 0, 0, 0},
      {gap(LawForm::gap_positive), -0.05, 0, 0, 0},
      {gap(LawForm::gap_negative), -0.05, 0, 0, -3},
      {gap(LawForm::gap_negative), 0.05, 0, 0, 0},
      {gap(LawForm::gap_both), 0.03, 0, 0, 1},
      {gap(LawForm::gap_both), -0.03, 0, 0, -1},
      {gap(LawForm::gap_both), 0.02, 0, 0, 0},
      {drift, 0.1, 0, 1, 0},
      {drift, 0.1, 0, 3, -0.25},
      {drift, 0.1, 0, 6, -1},
      {drift, -0.1, 0, 60, 1},
  };
  for (const Case& c : cases)
    EXPECT_NEAR(LawMotion(c.law).force(c.d, c.v, c.t), c.force, 1e-9)
        << static_cast<int>(c.law.form) << " at " << c.d << ", " << c.v << ", " << c.t;
}

TEST(Law, OnlyElementLawsHaveAForceHere) {
  for (const LawForm form :
       {LawForm::power, LawForm::saturating, LawForm::hysteresis, LawForm::sliders,
        LawForm::asymptotic, LawForm::masing, LawForm::pinched, LawForm::slip_lock, LawForm::slack,
        LawForm::peak_oriented, LawForm::friction, LawForm::power_damping, LawForm::amplitude,
        LawForm::gap_positive, LawForm::gap_negative, LawForm::gap_both, LawForm::changing})
    EXPECT_TRUE(is_element_law(form)) << static_cast<int>(form);
  for (const LawForm form :
       {LawForm::mass, LawForm::resonator, LawForm::spring, LawForm::damper, LawForm::rocking,
        LawForm::bending, LawForm::panels, LawForm::harmonic, LawForm::broadband,
        LawForm::misaligned, LawForm::swapped, LawForm::clipped}) {
    EXPECT_FALSE(is_element_law(form)) << static_cast<int>(form);
    EXPECT_EQ(LawMotion({form, {1, 1, 1}, 1, 1}).force(1, 1, 1), 0);
  }
}

/// Returns cycles of growing amplitude, with nested loops that pass the yield deformation.
VectorXd growing_cycles(Index steps) {
  VectorXd out(steps);
  for (Index i = 0; i < steps; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(steps);
    out[i] = 4 * kYields_m * turn * std::sin(2 * M_PI * 5 * turn);
  }
  return out;
}

/// Returns the forces of the simulator's law, integrated in steps of a two-hundredth.
VectorXd simulated_force(ElementLaw& law, const VectorXd& d) {
  constexpr int kFine = 200;
  std::vector<double> z(static_cast<std::size_t>(law.states())), rate = z;
  VectorXd out(d.size());
  double at = 0;
  for (Index i = 0; i < d.size(); ++i) {
    const double step = (d[i] - at) / kFine;
    for (int fine = 0; fine < kFine; ++fine) {
      law.begin_step(0, at);
      if (!z.empty()) law.rates(at, step, z, rate);
      for (std::size_t s = 0; s < z.size(); ++s) z[s] += rate[s];
      at += step;
    }
    out[i] = law.force(0, d[i], 0, z);
  }
  return out;
}

VectorXd simulated_force(const Effect& effect, const VectorXd& d) {
  return simulated_force(*make_law(effect, test::Small::one_story()), d);
}

TEST(Law, HysteresisMatchesTheSimulator) {
  constexpr double kTolerance = 0.01;  // of the force at yielding
  struct Case {
    LawForm form;
    std::vector<double> shape;  // after stiffness and yield deformation
    EffectKind kind;
  };
  for (const Case& c : {Case{LawForm::hysteresis, {1, 0.5}, EffectKind::bouc_wen},
                        Case{LawForm::hysteresis, {1, 0.5, 0.02, 0.03}, EffectKind::bouc_wen},
                        Case{LawForm::sliders, {0.8, 0.02}, EffectKind::bilinear_hysteresis},
                        Case{LawForm::pinched, {1, 0.5, 0.9, 0.4, 0.1, 3}, EffectKind::pinching},
                        Case{LawForm::hysteresis, {2, 0.7}, EffectKind::bouc_wen},
                        Case{LawForm::hysteresis, {6, 0.5}, EffectKind::bouc_wen},
                        Case{LawForm::hysteresis, {40, 0.5}, EffectKind::bilinear_hysteresis},
                        Case{LawForm::pinched, {2, 0.5, 0.8, 0.3}, EffectKind::pinching}}) {
    Effect effect = make_effect(c.kind, test::frame_place(0));
    effect.values[0] = kStiffness;
    effect.values[1] = kYields_m;
    LawValues law{c.form, {kStiffness, kYields_m}, 1, 1};
    for (std::size_t i = 0; i < c.shape.size(); ++i) {
      law.p.push_back(c.shape[i]);
      // The catalog's bilinear law has no exponent.
      const bool corner =
          c.form == LawForm::hysteresis && c.kind == EffectKind::bilinear_hysteresis;
      if (!corner) effect.values[i + 2] = c.shape[i];
    }
    const VectorXd d = growing_cycles(800);
    const VectorXd force = law_force(law, d, VectorXd::Zero(d.size()), 0.01);
    EXPECT_LT((force - simulated_force(effect, d)).cwiseAbs().maxCoeff(),
              kTolerance * kStiffness * kYields_m)
        << name_of(c.kind) << " " << c.shape.front();
    EXPECT_GT(force.maxCoeff(), 0.6 * kStiffness * kYields_m);
  }
}

VectorXd force_over(const LawValues& law, const VectorXd& d) {
  return law_force(law, d, VectorXd::Zero(d.size()), 0.01);
}

TEST(Law, SlidersThatYieldTogetherAreBilinear) {
  const VectorXd d = growing_cycles(800);
  const VectorXd sliders = force_over({LawForm::sliders, {kStiffness, kYields_m, 0}, 1, 1}, d);
  const VectorXd corner =
      force_over({LawForm::hysteresis, {kStiffness, kYields_m, 40, 0.5}, 1, 1}, d);
  EXPECT_LT((sliders - corner).cwiseAbs().maxCoeff(), 1e-9 * kStiffness * kYields_m);
}

/// Menegotto and Pinto's curve: its first loading, its slope after a reversal and its limit.
TEST(Law, SteelFollowsItsCurveFromEveryReversal) {
  constexpr double kSharpness = 5;
  const LawValues law{LawForm::asymptotic, {kStiffness, kYields_m, kSharpness, 0}, 1, 1};
  VectorXd d(4);
  d << 0.5 * kYields_m, 3 * kYields_m, 2.9 * kYields_m, -20 * kYields_m;
  const VectorXd force = force_over(law, d) / (kStiffness * kYields_m);
  const auto curve = [](double x) {
    return x / std::pow(1 + std::pow(x, kSharpness), 1 / kSharpness);
  };
  EXPECT_NEAR(force[0], curve(0.5), 1e-9);
  EXPECT_NEAR(force[1], curve(3), 1e-9);
  EXPECT_NEAR(force[1] - force[2], 0.1, 0.01);
  EXPECT_NEAR(force[3], -1, 0.05);
}

TEST(Law, SlippingJointsMatchTheSimulator) {
  constexpr double kAt_m = 4 * kYields_m, kSoftening = 0.2, kExponent = 1.4;
  Effect effect = make_effect(EffectKind::amplitude_dependence, test::building_place(Direction::x));
  effect.set("softening", kSoftening);
  effect.set("at_m", kAt_m);
  effect.set("exponent", kExponent);
  effect.set("slip", 1);
  const LawValues law{
      LawForm::amplitude, {-kSoftening * kStiffness * kAt_m, kExponent, 0, 2, 1}, kAt_m, 1};
  const VectorXd d = growing_cycles(800);
  const VectorXd force = force_over(law, d);
  const VectorXd simulated = simulated_force(*make_amplitude_law(effect, kStiffness), d);
  const double most = force.cwiseAbs().maxCoeff();
  EXPECT_GT(most, 0.8 * kSoftening * kStiffness * d.cwiseAbs().maxCoeff());
  EXPECT_LT((force - simulated).cwiseAbs().maxCoeff(), 0.01 * most);
}

/// Returns bilinear_hysteresis with kStiffness and kYields_m.
Effect yielding() {
  Effect out = make_effect(EffectKind::bilinear_hysteresis, test::frame_place(0));
  out.set("kh_npm", kStiffness);
  out.set("dy_m", kYields_m);
  return out;
}

TEST(Law, RoundYieldingMatchesTheSimulator) {
  const VectorXd d = growing_cycles(800);
  Effect effect = yielding();
  for (const double sharpness : {0.6, 1.0, 3.0, 20.0}) {
    effect.set("sharpness", sharpness);
    const VectorXd force =
        force_over({LawForm::masing, {kStiffness, kYields_m, sharpness}, 1, 1}, d);
    EXPECT_LT((force - simulated_force(effect, d)).cwiseAbs().maxCoeff(),
              0.01 * force.cwiseAbs().maxCoeff())
        << sharpness;
  }
}

TEST(Law, PeakOrientedYieldingMatchesTheSimulator) {
  VectorXd d = growing_cycles(800);
  for (Index i = 0; i < d.size(); ++i) d[i] += kYields_m * std::sin(0.2 * static_cast<double>(i));
  Effect effect = yielding();
  effect.set("peak_oriented", 1);
  for (const double unloading : {0.0, 0.5}) {
    effect.set("unloading", unloading);
    const VectorXd force =
        force_over({LawForm::peak_oriented, {kStiffness, kYields_m, unloading}, 1, 1}, d);
    EXPECT_LT((force - simulated_force(effect, d)).cwiseAbs().maxCoeff(),
              1e-9 * kStiffness * kYields_m)
        << unloading;
  }
}

TEST(Law, UnlikeYieldingMatchesTheSimulator) {
  const VectorXd d = growing_cycles(800);
  Effect effect = yielding();
  for (const double spread : {0.0, 0.6}) {
    effect.set("spread", spread);
    effect.set("asymmetry", -0.5);
    const VectorXd force =
        force_over({LawForm::sliders, {kStiffness, kYields_m, spread, 0, -0.5}, 1, 1}, d);
    EXPECT_LT((force - simulated_force(effect, d)).cwiseAbs().maxCoeff(),
              0.01 * kStiffness * kYields_m);
    EXPECT_NEAR(force.maxCoeff(), 0.5 * kStiffness * kYields_m, 1e-6);
    EXPECT_NEAR(force.minCoeff(), -1.5 * kStiffness * kYields_m, 1e-6);
  }
}

/// Soil: hyperbolic at first loading, and from a reversal toward its mirror image.
TEST(Law, RoundYieldingDoublesItsFirstLoading) {
  VectorXd d(3);
  d << 3 * kYields_m, kYields_m, -3 * kYields_m;
  const VectorXd z =
      force_over({LawForm::masing, {kStiffness, kYields_m, 1}, 1, 1}, d) / (kStiffness * kYields_m);
  EXPECT_NEAR(z[0], 3.0 / 4, kRounding);
  EXPECT_NEAR(z[1], 3.0 / 4 - 2 * 1.0 / 2, kRounding);
  EXPECT_NEAR(z[2], -3.0 / 4, kRounding);
}

/// Area of Masing's loop: 8 times the integral of first loading minus 4 times its end.
TEST(Law, SlippingJointsDissipateTheAreaOfTheirLoop) {
  constexpr double kExponent = 1.5;
  constexpr Index kSteps = 4000;
  const LawValues law{LawForm::amplitude, {-1, kExponent, 0, 2, 1}, 1, 1};
  VectorXd d(2 * kSteps);
  for (Index i = 0; i < d.size(); ++i) d[i] = std::sin(2 * M_PI * static_cast<double>(i) / kSteps);
  const VectorXd force = force_over(law, d);
  double loss = 0;
  for (Index i = kSteps / 4 + 1; i <= kSteps + kSteps / 4; ++i)
    loss += 0.5 * (force[i] + force[i - 1]) * (d[i] - d[i - 1]);
  EXPECT_NEAR(loss, 4 - 8 / (kExponent + 1), 1e-4);
}

TEST(Law, ASmallLoopDoesNotChangeTheLargeOne) {
  const LawValues law{LawForm::amplitude, {-1, 1.5, 0, 2, 1}, 1, 1};
  VectorXd d(6), without(4);
  d << 1, -0.2, 0.3, -0.1, -0.2, -0.6;
  without << 1, -0.2, -0.4, -0.6;
  EXPECT_NEAR(force_over(law, d)[5], force_over(law, without)[3], 1e-12);
  EXPECT_NEAR(force_over(law, d)[4], force_over(law, without)[1], 1e-12);
  VectorXd back(3);
  back << 1, -1, -1.5;  // closed at the other end: first loading again
  EXPECT_NEAR(force_over(law, back)[2], std::pow(1.5, 1.5), 1e-12);
}

/// A spring that loses the saturating part of its force, at D and d0 of 4 and 1 yield deformations.
double left_of_a_spring(double shape, double d) {
  constexpr double kD_m = 4 * kYields_m;
  const double lost = kD_m - kYields_m * bent(kD_m / kYields_m, shape);
  return d + LawMotion({LawForm::saturating, {-lost, kYields_m, shape}, kD_m, 1}).force(d, 0, 0);
}

TEST(Law, ASpringSoftensByItsShape) {
  for (const double x : {-3.0, -0.4, 0.01, 0.7, 2.0, 30.0}) {
    const double d = x * kYields_m;
    EXPECT_NEAR(left_of_a_spring(1, d), d / (1 + std::abs(x)), 1e-15) << "hyperbolic";
    EXPECT_NEAR(left_of_a_spring(2.5, d), kYields_m * std::tanh(x), 0.03 * kYields_m) << "tanh";
    EXPECT_NEAR(left_of_a_spring(60, d), std::clamp(d, -kYields_m, kYields_m), 0.02 * kYields_m)
        << "two slopes";
  }
}

TEST(Law, FarBelowItsSaturationASpringIsAPower) {
  constexpr double kFar_m = 1e3, kD_m = 0.1;
  for (const double shape : {1.0, 1.5, 2.0}) {
    const LawValues far{LawForm::saturating, {7, kFar_m, shape}, kD_m, 1};
    const LawValues power{LawForm::power, {7, shape + 1}, kD_m, 1};
    for (const double d : {-0.08, 0.03, 0.1})
      EXPECT_NEAR(LawMotion(far).force(d, 0, 0), LawMotion(power).force(d, 0, 0), 1e-3) << shape;
  }
}

TEST(Law, SaturatingSpringsMatchTheSimulator) {
  const VectorXd d = growing_cycles(400);
  for (const EffectKind kind : {EffectKind::quadratic_stiffness, EffectKind::cubic_stiffness})
    for (const double shape : {0.6, 1.0, 2.5, 20.0}) {
      Effect effect = make_effect(kind, test::frame_place(0));
      const int power = kind == EffectKind::cubic_stiffness ? 2 : 1;
      effect.values[0] = -kStiffness / (shape * std::pow(kYields_m, power));
      effect.set("saturation_m", kYields_m);
      effect.set("shape", shape);
      const double peak = 4 * kYields_m, lost = peak - kYields_m * bent(4, shape);
      const VectorXd force =
          force_over({LawForm::saturating, {-kStiffness * lost, kYields_m, shape}, peak, 1}, d);
      EXPECT_LT((force - simulated_force(effect, d)).cwiseAbs().maxCoeff(),
                1e-9 * force.cwiseAbs().maxCoeff())
          << name_of(kind) << " " << shape;
    }
}

TEST(Law, FramesThatSaturateMatchTheSimulator) {
  constexpr double kAt_m = 4 * kYields_m, kSoftening = 0.6, kSaturation = 0.3;
  const VectorXd d = growing_cycles(800);
  for (const double exponent : {1.6, 2.0, 3.5})
    for (const double slip : {0.0, 1.0}) {
      Effect effect =
          make_effect(EffectKind::amplitude_dependence, test::building_place(Direction::x));
      effect.set("softening", kSoftening);
      effect.set("at_m", kAt_m);
      effect.set("exponent", exponent);
      effect.set("slip", slip);
      effect.set("saturation_m", kSaturation * kAt_m);
      const LawValues law{LawForm::amplitude,
                          {-kSoftening * kStiffness * kAt_m, exponent, 0, 2, slip, kSaturation},
                          kAt_m,
                          1};
      const VectorXd force = force_over(law, d);
      const VectorXd simulated = simulated_force(*make_amplitude_law(effect, kStiffness), d);
      EXPECT_LT((force - simulated).cwiseAbs().maxCoeff(), 0.01 * force.cwiseAbs().maxCoeff())
          << exponent << " " << slip;
      LawMotion first(law);
      EXPECT_NEAR(first.force(kAt_m, 0, 0), law.p[0], 1e-6) << "softening is that at at_m";
    }
}

TEST(Law, SlipLocksAwayFromZeroDeformation) {
  const LawValues law{LawForm::slip_lock, {kStiffness, 10 * kYields_m, 1, 0.5, 0.9, 0.1}, 1, 1};
  VectorXd d(4);
  d << 0.1 * kYields_m, 0.2 * kYields_m, 4 * kYields_m, 4.1 * kYields_m;
  const VectorXd force = force_over(law, d);
  EXPECT_LT(force[1] - force[0], 0.2 * 0.1 * kStiffness * kYields_m);
  EXPECT_GT(force[3] - force[2], 0.5 * 0.1 * kStiffness * kYields_m);
}

/// Friction with a slip zone still yields: its tiny yield deformation is passed a thousand times in
/// every step.
TEST(Law, FrictionWithASlipZoneSlidesAtItsForce) {
  constexpr double kTiny_m = 1e-6;
  constexpr Index kSteps = 20000;
  const LawValues law{LawForm::slip_lock, {kStiffness, kTiny_m, 1, 0.5, 0.9, 0.1}, 1, 1};
  VectorXd d(kSteps);
  for (Index i = 0; i < kSteps; ++i)
    d[i] = 1e-3 * static_cast<double>(i % 20 < 10 ? i % 10 : 10 - i % 10);
  const VectorXd force = force_over(law, d) / (kStiffness * kTiny_m);
  for (Index i = 2; i < kSteps; ++i) EXPECT_NEAR(force[i], d[i] > d[i - 1] ? 1 : -1, 1e-9) << i;
}

TEST(Law, FrictionMayFallWithTheRateAndAContactOnlyPushes) {
  LawMotion stribeck({LawForm::friction, {10, 1e-4, 0.5, 0.1}, 1, 1});
  EXPECT_NEAR(stribeck.force(0, 0.002, 0), 15, 0.1);
  EXPECT_NEAR(stribeck.force(0, -1, 0), -10, 0.1);
  LawMotion contact({LawForm::gap_positive, {100, 0.02, 50}, 1, 1});
  EXPECT_NEAR(contact.force(0.05, 0.1, 0), 8, 1e-9);
  EXPECT_EQ(contact.force(0.05, -1, 0), 0);
  EXPECT_EQ(contact.force(0.01, 1, 0), 0);
}

TEST(Law, ElasticFrictionMatchesTheSimulator) {
  constexpr double kForce_n = 400, kGives_m = 2e-4, kPeak_m = 6e-3, kPeriod_s = 0.5;
  constexpr int kCycles = 3, kSteps = 400, kFiner = 50;
  const LawValues law{LawForm::friction, {kForce_n, 0.007, 0.3, 0.02, kGives_m}, 1, 1};
  Effect effect = make_effect(EffectKind::coulomb_friction, test::frame_place(0));
  effect.values = {law.p[0], law.p[1], 0, law.p[2], law.p[3], law.p[4]};
  const auto simulated = make_law(effect, test::Small().structure);
  ASSERT_EQ(simulated->states(), 1);

  const double h = kPeriod_s / kSteps, w = 2 * M_PI / kPeriod_s;
  VectorXd d(kCycles * kSteps), v(d.size());
  for (Index i = 0; i < d.size(); ++i) {
    const double t = h * static_cast<double>(i);
    d[i] = kPeak_m * std::sin(w * t);
    v[i] = i == 0 ? 0 : kPeak_m * w * std::cos(w * t);
  }
  const VectorXd force = law_force(law, d, v, h);
  std::vector<double> z(1), rate(1);
  double worst = 0;
  for (Index i = 1; i < d.size(); ++i) {
    for (int part = 0; part < kFiner; ++part) {
      const double t = h * (static_cast<double>(i - 1) + (part + 0.5) / kFiner);
      simulated->rates(0, kPeak_m * w * std::cos(w * t), z, rate);
      z[0] += h / kFiner * rate[0];
    }
    if (i > kSteps / 8) worst = std::max(worst, std::abs(force[i] - simulated->force(0, 0, 0, z)));
  }
  EXPECT_LT(worst, 0.02 * kForce_n);
  // At a reversal the force still equals that of the previous sliding.
  const Index reversal = kSteps + kSteps / 4 + 2;
  EXPECT_LT(v[reversal], 0);
  EXPECT_GT(force[reversal], 0.5 * kForce_n);
  LawValues rigid = law;
  rigid.p[4] = 0;
  EXPECT_LT(law_force(rigid, d, v, h)[reversal], 0);
}

TEST(Law, ASteadyBilinearLoopDissipatesItsArea) {
  constexpr double kAmplitude_m = 3 * kYields_m, kTolerance = 1e-3;
  constexpr Index kCycle = 4000;
  VectorXd d(2 * kCycle);
  for (Index i = 0; i < d.size(); ++i)
    d[i] = kAmplitude_m * std::sin(2 * M_PI * static_cast<double>(i) / kCycle);
  const VectorXd force = law_force({LawForm::hysteresis, {kStiffness, kYields_m, 40, 0.5}, 1, 1}, d,
                                   VectorXd::Zero(d.size()), 0.01);
  double work = 0;
  for (Index i = kCycle; i < d.size(); ++i)
    work += 0.5 * (force[i] + force[i - 1]) * (d[i] - d[i - 1]);
  EXPECT_NEAR(work / (4 * kStiffness * kYields_m * (kAmplitude_m - kYields_m)), 1, kTolerance);
}

TEST(Law, ComputingAForceChangesNoState) {
  const LawValues law{LawForm::hysteresis, {kStiffness, kYields_m, 2, 0.5}, 1, 1};
  LawMotion asked(law), silent(law);
  for (const double d : {0.001, 0.004, 0.002, -0.003}) {
    asked.force(10 * d, 1, 0);
    asked.force(-d, 1, 0);
    EXPECT_EQ(asked.force(d, 1, 0), silent.force(d, 1, 0));
    asked.force(-d, 1, 0);  // not where the step ends
    asked.accept(d, 1, 0);
    silent.accept(d, 1, 0);
    EXPECT_EQ(asked.force(-d, 1, 0), silent.force(-d, 1, 0));
  }
  EXPECT_NEAR(asked.force(-0.003, 0, 0), silent.force(-0.003, 7, 7), kRounding);
}

/// A step evaluated for several ends gives the same as one evaluated for the last end only.
TEST(Law, AStepOfHysteresisForgetsTriedEnds) {
  const std::vector<LawValues> laws{
      {LawForm::hysteresis, {kStiffness, kYields_m, 1.5, 0.4, 0.1, 0.05, -1}, 1, 1},
      {LawForm::pinched, {kStiffness, kYields_m, 2, 0.5, 0.8, 0.3, 0.1, 2, 0.1, 0.2}, 1, 1},
      {LawForm::slip_lock, {kStiffness, kYields_m, 1, 0.5, 0.8, 0.3}, 1, 1}};
  for (const LawValues& law : laws) {
    for (const double end : {-0.004, -1e-5, 1e-5, 0.004}) {
      LawMotion fresh(law), asked(law);
      for (LawMotion* motion : {&fresh, &asked})
        for (const double d : {0.002, 0.005, 0.001}) {
          motion->force(d, 0, 0);
          motion->accept(d, 0, 0);
        }
      for (const double other : {0.01, -0.01, 0.0012}) asked.force(other, 0, 0);
      EXPECT_EQ(asked.force(end, 0, 0), fresh.force(end, 0, 0));
    }
  }
}

TEST(Law, ForceOfAKnownMotionFollowsItsTime) {
  const LawValues law{LawForm::changing, {8, 0.25, 0.5}, 1, 1};
  const VectorXd force = law_force(law, VectorXd::Ones(5), VectorXd::Zero(5), 0.25);
  const VectorXd expected = (VectorXd(5) << 0, 0, 4, 8, 8).finished();
  EXPECT_LT((force - expected).norm(), kRounding);
  EXPECT_EQ(law_force(law, VectorXd(), VectorXd(), 0.25).size(), 0);
}

}  // namespace law_test

}  // namespace framewatch::estimator
