// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/next_measurement.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/effect_of.h"
#include "tests/estimator/diagnose/hidden_effect.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::daemon {
namespace next_measurement_test {

using enum estimator::EffectKind;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string between(estimator::EffectKind best, const std::vector<estimator::EffectKind>& rivals,
                    double peak_m = 0) {
  const test::Small small;
  const auto at = [](estimator::EffectKind kind) {
    return NamedEffect{kind, is_channel_effect(kind) ? test::at_channel(1) : test::in_frame(0)};
  };
  std::vector<NamedEffect> others;
  for (const estimator::EffectKind kind : rivals) others.push_back(at(kind));
  return measurement_between(at(best), others, small.structure, small.axes, peak_m);
}

TEST(MeasurementBetween, FollowsTheKindsOfTheRivals) {
  EXPECT_EQ(between(cubic_stiffness, {}), "");
  EXPECT_TRUE(has(between(gain_error, {cubic_stiffness}), "Exchange the sensor of channel y2"));
  EXPECT_TRUE(has(between(cubic_stiffness, {gain_error}), "Exchange the sensor of channel y2"));
  EXPECT_TRUE(has(between(cubic_stiffness, {unmeasured_force}), "while the ground rests"));
  EXPECT_TRUE(has(between(cubic_stiffness, {stiffness_drop}), "Record weak motion again"));
  EXPECT_TRUE(has(between(bouc_wen, {quadratic_damping}), "slowly to and fro"));
  EXPECT_TRUE(has(between(bouc_wen, {quadratic_damping}), "grows with speed"));
  EXPECT_TRUE(has(between(bouc_wen, {cubic_stiffness}), "enclose an area"));
  EXPECT_TRUE(has(between(cubic_stiffness, {bilinear_hysteresis}), "story 1, frame y1"));
  EXPECT_TRUE(has(between(extra_mass, {added_spring}), "known mass"));
  EXPECT_TRUE(has(between(added_spring, {added_damper}), "other frequencies"));
}

TEST(MeasurementBetween, LawsOfOneKindNeedAnotherAmplitude) {
  const std::string said = between(cubic_stiffness, {two_sided_gap}, 0.0123);
  EXPECT_TRUE(has(said, "stronger motion")) << said;
  EXPECT_TRUE(has(said, "12.3 mm")) << said;
  EXPECT_FALSE(has(between(cubic_stiffness, {two_sided_gap}), " mm"));
}

TEST(MeasurementBetween, PlacesNeedASensorOrAnotherMotion) {
  test::Small small = test::tower(3);
  const NamedEffect best{cubic_stiffness, test::frame_place(0, 2)},
      other{cubic_stiffness, test::frame_place(1, 2)};
  const auto said = [&] {
    return measurement_between(best, {other}, small.structure, small.axes, 0);
  };
  EXPECT_TRUE(has(said(), "deforms story 2, frame y1 and story 2, frame y2 differently")) << said();
  std::erase_if(small.axes,
                [](const estimator::SensorAxis& a) { return a.story == 2 && a.frame == 1; });
  EXPECT_TRUE(has(said(), "Put a sensor on floor 2, frame y2")) << said();
}

}  // namespace next_measurement_test
}  // namespace framewatch::daemon
