// SPDX-License-Identifier: MIT
#include "estimator/simulate/make_law.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/example_effects.h"

namespace framewatch::estimator {
namespace make_law_test {

constexpr double kPeak_m = 6e-3;
constexpr double kPeriod_s = 0.4;
constexpr int kStepsPerCycle = 4000;
/// Largest remainder of a closed loop of a law without memory, over the largest force times the
/// peak.
constexpr double kClosed = 1e-6;

/// A law driven along a motion, with midpoint integration of its states.
class Led {
 public:
  explicit Led(const Effect& effect)
      : law_(make_law(effect, test::table_model().structure)),
        z_(static_cast<std::size_t>(law_->states())),
        rate_(z_) {}

  void to(double d) {
    const double h = kPeriod_s / kStepsPerCycle;
    const double v = (d - d_) / h;
    law_->begin_step(time_s_, d_);
    const double before = law_->force(time_s_, d_, v, z_);
    law_->rates(d_, v, z_, rate_);
    std::vector<double> middle = z_;
    for (std::size_t i = 0; i < z_.size(); ++i) middle[i] += h / 2 * rate_[i];
    law_->rates((d + d_) / 2, v, middle, rate_);
    for (std::size_t i = 0; i < z_.size(); ++i) z_[i] += h * rate_[i];
    force_ = law_->force(time_s_ + h, d, v, z_);
    energy_j_ += (before + force_) / 2 * (d - d_);
    largest_ = std::max(largest_, std::abs(force_));
    d_ = d;
    time_s_ += h;
  }
  void cycles(int count) {
    for (int i = 1; i <= count * kStepsPerCycle; ++i)
      to(kPeak_m * std::sin(2 * M_PI * i / kStepsPerCycle));
  }
  double energy_j() const { return energy_j_; }
  double force() const { return force_; }
  double largest() const { return largest_; }

 private:
  std::unique_ptr<ElementLaw> law_;
  std::vector<double> z_, rate_;
  double d_ = 0, time_s_ = 0, force_ = 0, energy_j_ = 0, largest_ = 0;
};

Effect example(EffectKind kind) {
  return test::example_effect(kind, test::table_model());
}

TEST(ElementLaw, ConservesEnergyWithoutMemory) {
  using enum EffectKind;
  for (const EffectKind kind :
       {cubic_stiffness, quadratic_stiffness, one_sided_gap, two_sided_gap, p_delta}) {
    Led led(example(kind));
    led.cycles(1);
    EXPECT_NEAR(led.energy_j(), 0, kClosed * led.largest() * kPeak_m) << name_of(kind);
  }
}

TEST(ElementLaw, ASaturatingSpringConservesEnergyAndLevelsOff) {
  constexpr double kLevelsOff_m = 1e-3, kStiffness_npm = 2e4, kFar_m = 1e3;
  Effect hyperbolic = example(EffectKind::quadratic_stiffness);
  hyperbolic.set("k2_npm2", -kStiffness_npm / kLevelsOff_m);
  hyperbolic.set("saturation_m", kLevelsOff_m);
  Led led(hyperbolic);
  led.cycles(1);
  EXPECT_NEAR(led.energy_j(), 0, kClosed * led.largest() * kPeak_m);
  led.to(2e-3);  // k d/(1 + d/d0) - k d
  EXPECT_NEAR(led.force(), kStiffness_npm * 2e-3 * (1.0 / 3 - 1), 1e-9);

  Effect cubic = example(EffectKind::cubic_stiffness), saturates = cubic;
  saturates.set("saturation_m", kFar_m);
  Led power(cubic), far(saturates);
  power.to(kPeak_m);
  far.to(kPeak_m);
  EXPECT_NEAR(far.force(), power.force(), 1e-6 * power.force());
}

TEST(ElementLaw, HysteresisFrictionAndDampingDissipate) {
  using enum EffectKind;
  for (const EffectKind kind :
       {bilinear_hysteresis, bouc_wen, pinching, coulomb_friction, quadratic_damping}) {
    Led led(example(kind));
    double before = 0;
    for (int cycle = 0; cycle < 4; ++cycle) {
      led.cycles(1);
      EXPECT_GT(led.energy_j() - before, 0.05 * led.largest() * kPeak_m)
          << name_of(kind) << ", cycle " << cycle;
      before = led.energy_j();
    }
  }
}

/// Returns what the second cycle loses.
double second_loop_j(Led& led) {
  led.cycles(1);
  const double after_one = led.energy_j();
  led.cycles(1);
  return led.energy_j() - after_one;
}

TEST(ElementLaw, LoopsHaveTheirClosedForms) {
  Led bilinear(example(EffectKind::bilinear_hysteresis));
  const double kh = 1e4, dy = 1.5e-3;
  EXPECT_NEAR(second_loop_j(bilinear), 4 * kh * dy * (kPeak_m - dy), 1e-6);

  Led quadratic(example(EffectKind::quadratic_damping));
  quadratic.cycles(1);
  const double w = 2 * M_PI / kPeriod_s;
  EXPECT_NEAR(quadratic.energy_j(), 8.0 / 3 * 1e3 * w * w * std::pow(kPeak_m, 3),
              1e-4 * quadratic.energy_j());
}

TEST(ElementLaw, RoundYieldingLosesTheAreaOfMasingsLoop) {
  constexpr double kStiffness_npm = 1e4, kYields_m = 2e-3;
  Effect effect = example(EffectKind::bilinear_hysteresis);
  effect.set("kh_npm", kStiffness_npm);
  effect.set("dy_m", kYields_m);
  effect.set("sharpness", 1);
  Led led(effect);
  // 8 times the integral of first loading, k dy (d - dy log(1 + d/dy)), less 4 times its end.
  const double x = kPeak_m / kYields_m;
  const double unit = kStiffness_npm * kYields_m * kYields_m;
  EXPECT_NEAR(second_loop_j(led), unit * (8 * (x - std::log1p(x)) - 4 * x * x / (1 + x)),
              0.01 * unit);
}

TEST(ElementLaw, PeakOrientedYieldingReturnsToItsLargestDeformation) {
  constexpr double kStiffness_npm = 1e4, kYields_m = 2e-3;
  Effect effect = example(EffectKind::bilinear_hysteresis);
  effect.set("kh_npm", kStiffness_npm);
  effect.set("dy_m", kYields_m);
  effect.set("peak_oriented", 1);
  Led led(effect);
  // Half of the loop: a triangle from where it unloads to zero, over the way to the other peak.
  const double unit = kStiffness_npm * kYields_m * kYields_m, x = kPeak_m / kYields_m;
  EXPECT_NEAR(second_loop_j(led), unit * (2 * x - 2), 0.001 * unit);
  led.to(kPeak_m);
  EXPECT_NEAR(led.force(), kStiffness_npm * kYields_m, 1e-6);
}

TEST(ElementLaw, PositiveSizesPushBack) {
  using enum EffectKind;
  for (const EffectKind kind : {cubic_stiffness, quadratic_stiffness, bilinear_hysteresis, bouc_wen,
                                pinching, coulomb_friction, quadratic_damping, two_sided_gap}) {
    Led there(example(kind)), back(example(kind));
    for (int i = 1; i <= 1000; ++i) {
      there.to(i * kPeak_m / 1000);
      back.to(-i * kPeak_m / 1000);
    }
    EXPECT_GT(there.force(), 0) << name_of(kind);
    EXPECT_NEAR(back.force(), -there.force(), 1e-12 * there.force()) << name_of(kind);
  }
  Led weight(example(p_delta));
  weight.to(kPeak_m);
  EXPECT_NEAR(weight.force(), -3e3 / 1.0 * kPeak_m, 1e-12) << "W = 3 kN over 1 m";
}

TEST(ElementLaw, AOneSidedGapClosesOnItsSide) {
  Effect gap = example(EffectKind::one_sided_gap);
  for (const double side : {1.0, -1.0}) {
    gap.set("side", side);
    Led led(gap);
    led.to(-side * kPeak_m);
    EXPECT_EQ(led.force(), 0);
    led.to(side * kPeak_m);
    EXPECT_NEAR(led.force(), side * 3e4 * (kPeak_m - 2e-3), 1e-9);
  }
}

TEST(ElementLaw, ASlipZoneMakesTheLoopThinner) {
  Led thick(example(EffectKind::bouc_wen)), thin(example(EffectKind::pinching));
  thick.cycles(2);
  thin.cycles(2);
  EXPECT_LT(thin.energy_j(), 0.97 * thick.energy_j());
  Effect none = example(EffectKind::pinching);
  none.set("slip_ratio", 0);
  Led same(none);
  same.cycles(2);
  EXPECT_DOUBLE_EQ(same.energy_j(), thick.energy_j());
}

TEST(ElementLaw, StiffnessFallsAtItsTime) {
  Led drift(example(EffectKind::stiffness_drift));  // -5 kN/m from 1 s on, over 2 s
  drift.cycles(5);
  drift.to(1e-3);
  EXPECT_NEAR(drift.force(), -5e3 * 0.5 * 1e-3, 0.01);
  drift.cycles(5);
  drift.to(1e-3);
  EXPECT_NEAR(drift.force(), -5e3 * 1e-3, 1e-9);
}

}  // namespace make_law_test
}  // namespace framewatch::estimator
