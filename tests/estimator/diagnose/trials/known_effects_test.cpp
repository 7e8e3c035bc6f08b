// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/known_effects.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace known_effects_test {

using test::effect_of;
using test::Recorded;

constexpr double kRounding = 1e-12;

/// Effects added to the linear model of records that hide nothing.
struct Known {
  Recorded recorded;
  Model model = initial_model(recorded.plant);
  std::vector<FoundEffect> effects;

  explicit Known(const std::vector<Effect>& known, std::initializer_list<std::uint64_t> seeds = {1})
      : recorded(test::records_with({}, seeds)),
        effects(add_known(recorded.plant, recorded.segments, known, model)) {}
};

TEST(KnownEffects, AxisErrorsAreNotAmongTheModelsEffects) {
  const Known with({effect_of(EffectKind::gain_error, test::at_channel(0), {0.1}),
                    effect_of(EffectKind::polarity, test::at_channel(1), {}),
                    effect_of(EffectKind::time_shift, test::at_channel(2), {0.012}),
                    effect_of(EffectKind::bias_drift, test::at_channel(3), {0.02, 1})});
  const Model& model = with.model;
  const std::vector<FoundEffect>& known = with.effects;
  EXPECT_TRUE(model.effects.empty());
  ASSERT_EQ(known.size(), 4U);
  for (const FoundEffect& k : known) {
    EXPECT_EQ(k.index, -1);
    EXPECT_DOUBLE_EQ(k.confidence, 1);
  }
  EXPECT_NEAR(model.gain[0], 0.1, kRounding);
  EXPECT_NEAR(model.gain[1], -2, kRounding);
  EXPECT_NEAR(model.clock_s[2], 0.012, kRounding);
  EXPECT_EQ(model.free_gain, (std::vector<int>{0, 1}));
  EXPECT_EQ(model.free_clock, std::vector<int>{2});
  EXPECT_EQ(known[3].ramp_mps3, std::vector<double>{0.02});
  EXPECT_EQ(known[3].ramp_from_s, std::vector<double>{1});
}

TEST(KnownEffects, IndicesCountOnlyTheModelsEffects) {
  const Known with({effect_of(EffectKind::extra_mass, test::at_crossing(0), {300}),
                    effect_of(EffectKind::gain_error, test::at_channel(0), {0.1}),
                    effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e9})});
  ASSERT_EQ(with.model.effects.size(), 2U);
  const int indices[] = {0, -1, 1};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(with.effects[i].index, indices[i]) << i;
  EXPECT_EQ(with.model.effects[0].form, LawForm::mass);
  EXPECT_EQ(with.model.effects[1].form, LawForm::power);
}

TEST(KnownEffects, ScalesAreTheLargestMotionOfAnyRecord) {
  const Recorded recorded(test::records_with({}, {1, 2}));
  const Effect cubic = effect_of(EffectKind::cubic_stiffness, test::in_frame(2), {1e9});
  const auto law_of = [&](const std::vector<RecordSegment>& segments) {
    Model model = initial_model(recorded.plant);
    add_known(recorded.plant, segments, {cubic}, model);
    return model.effects.front();
  };
  const ModelEffect first = law_of({recorded.segments[0]}), second = law_of({recorded.segments[1]});
  const ModelEffect both = law_of(recorded.segments);
  EXPECT_DOUBLE_EQ(both.deformation, std::max(first.deformation, second.deformation));
  EXPECT_DOUBLE_EQ(both.rate, std::max(first.rate, second.rate));
  // The law's force is the catalog's, for any scale.
  const double d = 0.7 * both.deformation;
  EXPECT_NEAR(LawMotion(both.law(0)).force(d, 0, 0), 1e9 * std::pow(d, 3), 1e-6);
  EXPECT_NEAR(LawMotion(first.law(0)).force(d, 0, 0), 1e9 * std::pow(d, 3), 1e-6);
}

TEST(KnownEffects, AKnownMassIsNotFitted) {
  constexpr double kWeight_n = 2e5, kDrift_m = 3e-3;
  const Known with({effect_of(EffectKind::p_delta, test::in_frame(2), {kWeight_n})});
  const ModelEffect& law = with.model.effects.front();
  for (const LawParameter& parameter : law.parameters) EXPECT_FALSE(parameter.free);
  const double height = with.recorded.plant.structure.story_height[0];
  EXPECT_NEAR(LawMotion(law.law(0)).force(kDrift_m, 0, 0), -kWeight_n / height * kDrift_m, 1e-6);
}

TEST(KnownEffects, EveryRecordHasItsOwnTimes) {
  constexpr double kForever_s = 1e6;
  const Known with({effect_of(EffectKind::stiffness_drop, test::in_frame(2), {-1e5, kForever_s}),
                    effect_of(EffectKind::stiffness_drift, test::in_frame(2), {-1e5, 3, 8}),
                    effect_of(EffectKind::unmeasured_force, test::at_node(1),
                              {100, 3, M_PI / 2, 0, 0.1, 10, 1, 5})},
                   {1, 2});
  const Model& model = with.model;
  for (const ModelEffect& e : model.effects) ASSERT_EQ(e.record_parameters.size(), 2U);
  // A drop after the record counts at its end; its duration is not fitted.
  EXPECT_NEAR(model.effects[0].record_parameters[1][0].plain(), with.recorded.segments[1].seconds(),
              kRounding);
  EXPECT_FALSE(model.effects[0].record_parameters[0][1].free);
  EXPECT_TRUE(model.effects[1].record_parameters[0][1].free);
  EXPECT_NEAR(model.effects[1].record_parameters[0][1].plain(), 8, kRounding);
  // A quarter of a period later the force is a pure cosine.
  EXPECT_NEAR(model.effects[2].record_parameters[1][0].plain(), 100, 1e-9);
  EXPECT_NEAR(model.effects[2].record_parameters[1][1].plain(), 0, 1e-9);
  EXPECT_EQ(model.effects[2].onset_s, (std::vector<double>{5, 5}));
}

}  // namespace known_effects_test
}  // namespace framewatch::estimator
