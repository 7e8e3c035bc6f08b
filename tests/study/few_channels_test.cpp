// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "daemon/tools/lab/few_sensors.h"
#include "estimator/diagnose/fit/diagnosis_input.h"
#include "estimator/diagnose/verdict/diagnose.h"

// Twenty stories with channels at the base and on four floors; other floors follow from theirs.
namespace framewatch::estimator {
namespace few_channels_test {

using Eigen::Index;

constexpr int kFloor10 = 2;  // its channel
constexpr double kRate_hz = 100;

daemon::TallTrial trial_of(std::uint64_t seed) {
  daemon::TallTrial trial;
  trial.duration_s = 60;
  trial.seed = seed;
  return trial;
}

/// Returns two records of one building, both strong all the time.
DiagnosisInput input_of(daemon::TallTrial trial, double factor_of_floor_10 = 1) {
  daemon::TallRecord record = tall_record(trial);
  record.accel.col(kFloor10) *= factor_of_floor_10;
  const Index half = record.accel.rows() / 2;
  return *diagnosis_input(
      record.config.structure, record.config.axes, record.config.design, {},
      {{kRate_hz, record.accel.topRows(half), 0}, {kRate_hz, record.accel.bottomRows(half), 0}},
      record.config.bending_nmprad);
}

Diagnosis diagnosed(const DiagnosisInput& input) {
  DiagnosisOptions options;
  options.holdout_from = 1;
  return diagnose(input.plant, input.segments, options);
}

TEST(FewChannels, FindTheModelAdequateIfNothingIsHidden) {
  const DiagnosisInput input = input_of(trial_of(1));
  EXPECT_EQ(input.plant.equations(), 20);
  EXPECT_EQ(input.plant.read_equations(), 4);
  const Diagnosis d = diagnosed(input);
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_LT(d.before[0].overall, 1.3 * d.before[0].overall_floor);
}

TEST(FewChannels, FindAChannelOfAnotherScale) {
  const Diagnosis d = diagnosed(input_of(trial_of(1), 1.1));
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::gain_error);
  EXPECT_EQ(d.effects[0].chosen.place.channel, kFloor10);
  EXPECT_NEAR(d.model.gain[kFloor10], 0.1, 0.01);
  EXPECT_EQ(d.verdict, Verdict::explained);
}

TEST(FewChannels, FindATurnedChannel) {
  const Diagnosis d = diagnosed(input_of(trial_of(1), -1));
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::polarity);
  EXPECT_EQ(d.effects[0].chosen.place.channel, kFloor10);
  EXPECT_EQ(d.verdict, Verdict::explained);
}

TEST(FewChannels, FindAHiddenOscillatorOnTheRoof) {
  constexpr double kMass_kg = 80e3, kFrequency_hz = 1.3;
  daemon::TallTrial trial = trial_of(1);
  EffectPlace roof;
  roof.kind = PlaceKind::node;
  roof.story = 20;
  roof.frame = 0;
  trial.hidden.push_back(make_effect(EffectKind::tuned_mass_damper, roof));
  trial.hidden.back().set("mass_kg", kMass_kg);
  trial.hidden.back().set("frequency_hz", kFrequency_hz);
  trial.hidden.back().set("damping_ratio", 0.03);
  const Diagnosis d = diagnosed(input_of(trial));
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::tuned_mass_damper);
  EXPECT_EQ(d.effects[0].chosen.place.story, 20);
  const ModelEffect& found = d.model.effects[static_cast<std::size_t>(d.effects[0].index)];
  EXPECT_NEAR(found.parameters[1].plain(), kFrequency_hz, 0.02 * kFrequency_hz);
  EXPECT_EQ(d.verdict, Verdict::explained);
}

TEST(FewChannels, FitTheBendingOfTheDesignOrNameIt) {
  constexpr double kTruth_nmprad = 3e12;
  daemon::TallTrial trial = trial_of(1);
  trial.bending_nmprad = kTruth_nmprad;
  trial.believed_bending_nmprad = 2 * kTruth_nmprad;
  const Diagnosis bends = diagnosed(input_of(trial));
  EXPECT_EQ(bends.verdict, Verdict::adequate);
  ASSERT_FALSE(bends.model.effects.empty());
  ASSERT_EQ(bends.model.effects[0].form, LawForm::bending);
  EXPECT_NEAR(bends.model.effects[0].parameters[0].plain() * kTruth_nmprad, 1, 0.02);
  trial.believed_bending_nmprad = 0;
  const Diagnosis shears = diagnosed(input_of(trial));
  ASSERT_EQ(shears.effects.size(), 1U);
  EXPECT_EQ(shears.effects[0].chosen.kind, EffectKind::frame_bending);
  EXPECT_EQ(shears.verdict, Verdict::explained);
}

}  // namespace few_channels_test
}  // namespace framewatch::estimator
