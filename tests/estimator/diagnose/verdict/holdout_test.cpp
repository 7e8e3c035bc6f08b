// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/verdict/verdict.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace holdout_test {

using test::Recorded;

constexpr double kAtFloor = 1.3;  // gap of the true model over that of noise

Gap gap_with(double overall) {
  Gap out;
  out.overall = overall;
  return out;
}

TEST(MeanGap, AveragesHeldOutSegments) {
  const std::vector<Gap> gaps{gap_with(9), gap_with(1), gap_with(4)};
  EXPECT_DOUBLE_EQ(mean_gap(gaps, 1), 2.5);
  EXPECT_DOUBLE_EQ(mean_gap(gaps, 2), 4);
  EXPECT_DOUBLE_EQ(mean_gap(gaps, 0), 14.0 / 3);
  EXPECT_DOUBLE_EQ(mean_gap(gaps, 3), 0);
  EXPECT_DOUBLE_EQ(mean_gap({}, 0), 0);
}

TEST(Gaps, TheTrueModelIsAtTheNoiseFloorAndAWrongOneFarAbove) {
  const Recorded recorded(test::records_with({}, {1, 2}));
  Model truth = initial_model(recorded.plant);
  truth.theta = recorded.small.truth;
  const std::vector<Gap> gaps = gaps_of(recorded.fitter, truth);
  ASSERT_EQ(gaps.size(), 2U);
  for (const Gap& g : gaps) {
    EXPECT_LT(g.overall, kAtFloor * g.overall_floor);
    EXPECT_DOUBLE_EQ(g.axis.tail(2).norm(), 0) << "the base drives";
    EXPECT_DOUBLE_EQ(g.worst, g.axis.maxCoeff());
    EXPECT_DOUBLE_EQ(g.axis[g.worst_axis], g.worst);
  }
  Model wrong = truth;
  wrong.theta[recorded.small.table.frame_stiffness(1, 0)] *= 1.2;
  const std::vector<Gap> of_wrong = gaps_of(recorded.fitter, wrong);
  for (const Gap& g : of_wrong) EXPECT_GT(g.overall, 5 * g.overall_floor);
  // Frame 0 is x-parallel, and so are the axes where it shows most.
  EXPECT_LT(of_wrong[0].worst_axis, 2);
}

/// Records of a building that was softer when the second was made.
struct Softened {
  static Eigen::MatrixXd later() {
    test::Small softer;
    softer.truth.head(4) *= 0.9;
    return softer.record({}, 2);
  }
  Recorded recorded{{test::Small().record({}, 1), later()}};
  Diagnosis diagnosis;

  explicit Softened(std::size_t holdout_from) {
    diagnosis.linear = diagnosis.model = recorded.linear().model;
    set_gaps(recorded.fitter, test::held_out_from(holdout_from), diagnosis);
  }
};

TEST(Holdout, HeldOutRecordsDoNotInfluenceTheModel) {
  const Softened one(1), both(2);
  // Fitted to the first record alone, it is at its floor there and far off in the second.
  EXPECT_LT(one.diagnosis.before[0].overall, kAtFloor * one.diagnosis.before[0].overall_floor);
  EXPECT_LT(one.diagnosis.before[0].overall, 0.5 * both.diagnosis.before[0].overall);
  EXPECT_GT(one.diagnosis.before[1].overall, 1.2 * both.diagnosis.before[1].overall);
}

TEST(Holdout, TheGapStaysWithoutEffects) {
  const Softened d(1);
  ASSERT_EQ(d.diagnosis.after.size(), d.diagnosis.before.size());
  for (std::size_t r = 0; r < d.diagnosis.after.size(); ++r)
    EXPECT_DOUBLE_EQ(d.diagnosis.after[r].overall, d.diagnosis.before[r].overall);
  EXPECT_FALSE(d.diagnosis.after_of_all);
}

TEST(Holdout, FitsParametersUnseenInTrainingToAllRecords) {
  // A reading that is wrong in both records, or only in the second: then the first contains no sign
  // of it.
  constexpr double kGain = 0.3;
  for (const bool determined : {true, false}) {
    std::vector<Eigen::MatrixXd> records = test::records_with({}, {1, 2});
    records[1].col(1) *= 1 + kGain;
    if (determined) records[0].col(1) *= 1 + kGain;
    const Recorded recorded(records);
    Diagnosis d;
    d.linear = d.model = recorded.linear().model;
    d.model.free_gain = {1};
    d.model.gain[1] = kGain;
    d.model = recorded.fitter.fit(d.model, {}, {}).model;
    d.effects.emplace_back();
    set_gaps(recorded.fitter, test::held_out_from(1), d);
    EXPECT_EQ(d.after_of_all, !determined);
    const double of_all = mean_gap(gaps_of(recorded.fitter, d.model), 1);
    if (determined) {
      EXPECT_LT(mean_gap(d.after, 1), 0.2 * mean_gap(d.before, 1));
    } else {
      EXPECT_DOUBLE_EQ(mean_gap(d.after, 1), of_all);
    }
  }
}

}  // namespace holdout_test
}  // namespace framewatch::estimator
