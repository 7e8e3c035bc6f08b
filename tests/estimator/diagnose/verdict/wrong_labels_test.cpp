#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/diagnose.h"
#include "tests/estimator/diagnose/hidden_effect.h"

// Channels whose label or sign is wrong, as they come from the wiring of real buildings.
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

TEST(WrongLabels, ABaseSensorTurnedByHalfATurnIsFound) {
  for (const Index axis : {kBaseX, kBaseY}) {
    const Diagnosis d = diagnosed(turned(test::records_with({}, {1, 2}), axis));
    ASSERT_EQ(d.effects.size(), 1U) << axis;
    EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::polarity);
    EXPECT_EQ(d.effects[0].chosen.place.channel, axis);
    EXPECT_EQ(d.verdict, Verdict::explained);
  }
}

}  // namespace wrong_labels_test
}  // namespace framewatch::estimator
