// SPDX-License-Identifier: MIT
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/diagnose.h"
#include "tests/estimator/diagnose/hidden_effect.h"

// Channels with a wrong label or sign, as caused by the wiring of real buildings.
namespace framewatch::estimator {
namespace wrong_labels_test {

using Eigen::Index;
using Eigen::MatrixXd;
using test::Small;

constexpr Index kBaseX = 4, kBaseY = 5;

Diagnosis diagnosed(const std::vector<MatrixXd>& records) {
  const Small small;
  const Plant plant = small.plant();
  return diagnose(plant, small.segments(records), {});
}

std::vector<MatrixXd> turned(std::vector<MatrixXd> records, Index axis) {
  for (MatrixXd& record : records) record.col(axis) *= -1;
  return records;
}

TEST(WrongLabels, FindABaseSensorTurnedByHalfATurn) {
  for (const Index axis : {kBaseX, kBaseY}) {
    const Diagnosis d = diagnosed(turned(test::records_with({}, {1, 2}), axis));
    ASSERT_EQ(d.effects.size(), 1U) << axis;
    EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::polarity);
    EXPECT_EQ(d.effects[0].chosen.place.channel, axis);
    EXPECT_EQ(d.verdict, Verdict::explained);
  }
}

TEST(WrongLabels, FindTwoExchangedChannelsOfAStory) {
  for (const auto& [a, b] : {std::pair<Index, Index>{0, 1}, {1, 3}}) {
    std::vector<MatrixXd> records = test::records_with({}, {1, 2});
    for (MatrixXd& record : records) record.col(a).swap(record.col(b));
    const Diagnosis d = diagnosed(records);
    ASSERT_EQ(d.effects.size(), 1U) << a << " " << b;
    EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::swapped);
    EXPECT_EQ(d.effects[0].chosen.place.channel, a);
    EXPECT_EQ(d.effects[0].chosen.place.with_channel, b);
  }
}

TEST(WrongLabels, FindALawBesideATurnedBaseSensor) {
  const Diagnosis d = diagnosed(
      turned(test::records_with(
                 {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {2e9})}, {1, 2}),
             kBaseX));
  ASSERT_EQ(d.effects.size(), 2U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::polarity);
  EXPECT_EQ(d.effects[0].chosen.place.channel, kBaseX);
  EXPECT_EQ(d.effects[1].chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_EQ(d.effects[1].chosen.place.frame, 1);
}

}  // namespace wrong_labels_test
}  // namespace framewatch::estimator
