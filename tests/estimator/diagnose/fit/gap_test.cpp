// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/gap.h"

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/law_tracks.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace gap_test {

using Eigen::Index;
using Eigen::MatrixXd;
using test::Small;

struct Case {
  Small small;
  Plant plant = small.plant();
  Model model = test::true_model(small, plant);

  Gap gap(const MatrixXd& record, const Model& of) const {
    const RecordSegment segment = small.segments({record}).front();
    const Whitened system = whiten(plant, of, segment, 0, Forcing::simulated, {}, 2);
    return gap_of(plant, of, segment, system);
  }
};

TEST(Gap, EqualsTheNoiseForTheTrueModel) {
  constexpr double kTolerance = 0.25, kOfAll = 0.12;
  const Case c;
  const Gap gap = c.gap(c.small.record({}, 1), c.model);
  for (Index a = 0; a < 4; ++a) {
    EXPECT_GT(gap.floor[a], 0);
    EXPECT_NEAR(gap.axis[a] / gap.floor[a], 1, kTolerance) << a;
  }
  EXPECT_NEAR(gap.overall / gap.overall_floor, 1, kOfAll);
  EXPECT_EQ(gap.axis[4], 0);
  EXPECT_EQ(gap.axis[5], 0);
  EXPECT_EQ(gap.floor[4], 0);
  EXPECT_DOUBLE_EQ(gap.worst, gap.axis.maxCoeff());
  EXPECT_EQ(gap.axis[gap.worst_axis], gap.worst);
}

TEST(Gap, VanishesWithoutNoise) {
  constexpr double kOfFloor = 0.1;
  const Case c;
  const Gap gap = c.gap(test::exact_record(c.small, {}, 1), c.model);
  EXPECT_LT(gap.overall, kOfFloor * gap.overall_floor);
}

TEST(Gap, FallsWithTheNoise) {
  constexpr double kTolerance = 0.02;
  Case c;
  const MatrixXd record = test::exact_record(c.small, {}, 1);
  RecordSegment segment = c.small.segments({record}).front();
  const auto floor = [&] {
    return gap_of(c.plant, c.model, segment,
                  whiten(c.plant, c.model, segment, 0, Forcing::simulated, {}, 2))
        .overall_floor;
  };
  const double before = floor();
  segment.variance *= 4;
  EXPECT_NEAR(floor() / before, 2, kTolerance);
}

TEST(Gap, ShowsAWrongReadingUntilTheModelIncludesIt) {
  constexpr double kGain = 0.1, kTolerance = 0.1;
  constexpr int kAxis = 1;
  Case c;
  MatrixXd record = c.small.record({}, 1);
  record.col(kAxis) *= 1 + kGain;
  const Gap before = c.gap(record, c.model);
  EXPECT_EQ(before.worst_axis, kAxis);
  EXPECT_NEAR(before.worst * (1 + kGain) / kGain, 1, 2 * kTolerance);
  c.model.gain[kAxis] = kGain;
  const Gap after = c.gap(record, c.model);
  EXPECT_LT(after.overall, (1 + kTolerance) * after.overall_floor);
}

TEST(Gap, ClosesWhenTheModelIncludesTheLaw) {
  constexpr double kShows = 3, kNear = 1.15;  // times the floor
  const Case c;
  const test::EffectTwins twins = test::cubic_spring(2, 2e11);
  const MatrixXd record = c.small.record({twins.simulated}, 1);
  const Gap before = c.gap(record, c.model);
  EXPECT_GT(before.overall, kShows * before.overall_floor);
  const Gap after = c.gap(record, test::with_effects(c.model, {twins.modelled}));
  EXPECT_LT(after.overall, kNear * after.overall_floor);
}

TEST(Gap, FreeForcesExplainTheirNode) {
  constexpr double kShows = 3, kNear = 1.2;
  const Case c;
  const auto node = test::node_place(2);
  Effect force = make_effect(EffectKind::unmeasured_force, node);
  force.set("amplitude_n", 5000);
  force.set("frequency_hz", 3.1);
  force.set("rms_n", 0);
  const MatrixXd record = c.small.record({force}, 1);
  const Gap before = c.gap(record, c.model);
  EXPECT_GT(before.overall, kShows * before.overall_floor);
  const Gap after =
      c.gap(record, test::with_effects(c.model, {test::effect_of(LawForm::broadband, node, {})}));
  EXPECT_LT(after.overall, kNear * after.overall_floor);
}

TEST(Gap, ComparesAClippedReadingWithAClippedModel) {
  constexpr double kBetter = 0.3;
  constexpr int kAxis = 0;
  const Case c;
  MatrixXd record = c.small.record({}, 1);
  const double level = 0.5 * record.col(kAxis).cwiseAbs().maxCoeff();
  record.col(kAxis) = record.col(kAxis).cwiseMax(-level).cwiseMin(level);
  const Gap before = c.gap(record, c.model);
  EXPECT_EQ(before.worst_axis, kAxis);
  const Gap after = c.gap(
      record, test::with_effects(
                  c.model, {test::effect_of(LawForm::clipped, test::channel_place(kAxis), {})}));
  EXPECT_LT(after.axis[kAxis], kBetter * before.axis[kAxis]);
}

}  // namespace gap_test
}  // namespace framewatch::estimator
