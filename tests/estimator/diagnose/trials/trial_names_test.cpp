// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/trial_names.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace trial_names_test {

using test::HandMade;

constexpr double kPeak_m = 0.01;
// Limits of names.
constexpr double kNarrowestSlip = 0.08;
constexpr double kNear = 0.01;

ModelEffect effect_with(LawForm form, const EffectPlace& place,
                        std::vector<LawParameter> parameters) {
  ModelEffect out;
  out.form = form;
  out.place = place;
  out.parameters = std::move(parameters);
  out.deformation = kPeak_m;
  return out;
}

/// Returns true if an effect that a trial adds may be named.
bool may_have_name(const ModelEffect& effect, EffectKind kind) {
  static const HandMade made;
  Trial t = made.trial(kind, 1);
  t.model.effects.push_back(effect);
  return may_be_named(made.context(), t);
}

TEST(TrialNames, SpringsPullAndDampersDissipate) {
  for (const LawForm form : {LawForm::spring, LawForm::damper, LawForm::rocking, LawForm::bending})
    for (const double size : {1e4, -1e4})
      EXPECT_EQ(may_have_name(effect_with(form, test::at_node(0), {linear_parameter(size, 1)}),
                              EffectKind::added_spring),
                size > 0);
  // A mass may be negative, a law may soften.
  EXPECT_TRUE(
      may_have_name(effect_with(LawForm::mass, test::at_crossing(0), {linear_parameter(-10, 1)}),
                    EffectKind::extra_mass));
  EXPECT_TRUE(may_have_name(effect_with(LawForm::power, test::in_frame(0),
                                        {linear_parameter(-10, 1), linear_parameter(3, 1)}),
                            EffectKind::cubic_stiffness));
}

struct Case {
  const char* what;
  ModelEffect effect;
  bool named;
};

void expect_named(EffectKind kind, const std::vector<Case>& cases) {
  for (const Case& c : cases) EXPECT_EQ(may_have_name(c.effect, kind), c.named) << c.what;
}

ModelEffect oscillator(double mass_kg, double hz, double damping) {
  return effect_with(LawForm::resonator, test::at_node(2),
                     {linear_parameter(mass_kg, 1), logarithmic_parameter(hz, 0.1, 100),
                      logarithmic_parameter(damping, 1e-3, 2)});
}

TEST(TrialNames, AnOscillatorIsLighterThanItsFloorAndDamped) {
  constexpr double kDulled = 0.4;
  const HandMade made;
  const double floor_kg = made.recorded.plant.structure.frame_mass(1, 2), kg = 0.1 * floor_kg;
  const Eigen::VectorXd& w = made.recorded.segments.front().w;
  const double highest_hz = w[w.size() - 1] / (2 * M_PI);
  expect_named(EffectKind::tuned_mass_damper,
               {{"as built", oscillator(kg, 2.5, 0.05), true},
                {"as heavy as its floor", oscillator((1 - kNear) * floor_kg, 2.5, 0.05), true},
                {"heavier than its floor", oscillator((1 + kNear) * floor_kg, 2.5, 0.05), false},
                {"at the band's end", oscillator(kg, (1 - kNear) * highest_hz, 0.05), true},
                {"above the band", oscillator(kg, (1 + kNear) * highest_hz, 0.05), false},
                {"damped, but it resonates", oscillator(kg, 2.5, (1 - kNear) * kDulled), true},
                {"too damped to resonate", oscillator(kg, 2.5, (1 + kNear) * kDulled), false},
                {"as damped as may be", oscillator(kg, 2.5, 2), false},
                {"as little damped as may be", oscillator(kg, 2.5, 1e-3), false}});
}

/// yield: in peak deformations.
ModelEffect slipping(double yield, double ratio, double width) {
  return effect_with(
      LawForm::pinched, test::in_frame(2),
      {linear_parameter(4e6, 1), logarithmic_parameter(yield * kPeak_m, 1e-6, 1),
       bounded_parameter(2, 0.05, 0.5, 60), bounded_parameter(0.5, 0.02, 0.1, 1),
       bounded_parameter(ratio, 0.02, 0.3, 0.99), logarithmic_parameter(width, 0.05, 1)});
}

TEST(TrialNames, ASlipZoneNeedsYieldingAndWidth) {
  expect_named(EffectKind::pinching,
               {{"a pinched loop", slipping(0.2, 0.9, 0.3), true},
                {"hardly yields", slipping(2.5, 0.9, 0.3), false},
                {"as narrow as a corner", slipping(0.2, 0.9, (1 - kNear) * kNarrowestSlip), false},
                {"just wide enough", slipping(0.2, 0.9, (1 + kNear) * kNarrowestSlip), true},
                {"at its largest ratio", slipping(0.2, 0.99, 0.3), false},
                {"at its least ratio", slipping(0.2, 0.3, 0.3), false},
                {"at its largest width", slipping(0.2, 0.9, 1), false}});
}

TEST(TrialNames, ExcludedNamesAreNotGiven) {
  HandMade made;
  Trial t = made.trial(EffectKind::extra_mass, 1);
  EXPECT_TRUE(may_be_named(made.context(), t));
  t.second = std::pair(EffectKind::gain_error, test::at_channel(1));
  made.without = {EffectKind::gain_error};
  EXPECT_TRUE(is_excluded(made.context(), EffectKind::gain_error));
  EXPECT_FALSE(is_excluded(made.context(), EffectKind::extra_mass));
  EXPECT_FALSE(may_be_named(made.context(), t));
  t.second.reset();
  EXPECT_TRUE(may_be_named(made.context(), t));
  made.without = {EffectKind::extra_mass};
  EXPECT_FALSE(may_be_named(made.context(), t));
}

/// Returns a trial with these first guesses after a fit that added these effects at a cost of 123.
Trial taken(const HandMade& made, EffectKind first, EffectKind second,
            const std::vector<ModelEffect>& added) {
  FitResult run = made.now;
  run.cost = 123;
  run.misfit = {100};
  run.model.effects = added;
  Trial out = made.trial(first, 1);
  out.second = std::pair(second, test::in_frame(1));
  set_fit(made.context(), run, out);
  return out;
}

TEST(TrialNames, ATrialTakesTheNameOfItsFit) {
  const ModelEffect power = effect_with(LawForm::power, test::in_frame(2),
                                        {linear_parameter(1, 1), linear_parameter(2.1, 1)});
  const ModelEffect friction =
      effect_with(LawForm::friction, test::in_frame(1), {linear_parameter(1, 1)});
  const Trial t =
      taken(HandMade(), EffectKind::cubic_stiffness, EffectKind::bouc_wen, {power, friction});
  EXPECT_EQ(name_of(t.kind), "quadratic_stiffness");
  EXPECT_EQ(name_of(t.second->first), "coulomb_friction");
  EXPECT_DOUBLE_EQ(t.cost, 123);
  EXPECT_EQ(t.misfit, std::vector<double>{100});
  EXPECT_EQ(t.model.effects.size(), 2U);
}

TEST(TrialNames, AnAxisErrorKeepsItsNameAndTakesNoEffects) {
  const ModelEffect mass =
      effect_with(LawForm::mass, test::at_crossing(0), {linear_parameter(1, 1)});
  const Trial t = taken(HandMade(), EffectKind::gain_error, EffectKind::added_spring, {mass});
  EXPECT_EQ(name_of(t.kind), "gain_error");
  EXPECT_EQ(name_of(t.second->first), "extra_mass");
}

TEST(TrialNames, FollowTheShapesOfTheLastFit) {
  HandMade made;
  made.now.model.effects.push_back(effect_with(LawForm::power, test::in_frame(1),
                                               {linear_parameter(1, 1), linear_parameter(2, 1)}));
  std::vector<FoundEffect> effects(2);
  effects[0].chosen.kind = EffectKind::cubic_stiffness;
  effects[0].like = {EffectKind::quadratic_stiffness, EffectKind::two_sided_gap};
  effects[0].index = 0;
  effects[1].chosen.kind = EffectKind::gain_error;
  effects[1].index = -1;
  const std::vector<FoundEffect> before = effects;
  name_by_shape(made.context(), effects);
  EXPECT_EQ(effects[0].chosen.kind, EffectKind::quadratic_stiffness);
  EXPECT_EQ(effects[0].like, std::vector{EffectKind::two_sided_gap});
  EXPECT_EQ(effects[1].chosen.kind, EffectKind::gain_error);
  made.without = {EffectKind::quadratic_stiffness};
  effects = before;
  name_by_shape(made.context(), effects);
  EXPECT_EQ(effects[0].chosen.kind, EffectKind::cubic_stiffness);
}

TEST(TrialNames, IgnoredEquationsCostOnePerBin) {
  const HandMade made;
  const Trial t = taken(made, EffectKind::unmeasured_force, EffectKind::gain_error,
                        {effect_with(LawForm::broadband, test::at_node(2), {})});
  EXPECT_DOUBLE_EQ(t.cost - 123, static_cast<double>(made.recorded.segments.front().bins()));
}

}  // namespace trial_names_test
}  // namespace framewatch::estimator
