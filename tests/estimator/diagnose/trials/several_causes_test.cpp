// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/several_causes.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "estimator/diagnose/trials/round_trials.h"
#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace several_causes_test {

using test::HandMade;

constexpr double kGain = 0.2, kGainOff = 0.01, kCubic_npm3 = 8e10;

/// Returns two records of a cubic spring at frame 2 and a channel that reads too much.
std::vector<Eigen::MatrixXd> records_of_two_causes() {
  std::vector<Eigen::MatrixXd> out = test::records_with(
      {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(2), {kCubic_npm3})}, {1, 2});
  for (Eigen::MatrixXd& record : out) record.col(0) *= 1 + kGain;
  return out;
}

/// Returns two records of only a channel that reads too much.
std::vector<Eigen::MatrixXd> records_of_one_cause() {
  std::vector<Eigen::MatrixXd> out = test::records_with({}, {1, 2});
  for (Eigen::MatrixXd& record : out) record.col(0) *= 1 + kGain;
  return out;
}

std::vector<Trial> tried_at(const HandMade& made, const std::vector<EffectPlace>& places) {
  std::vector<Localisation> freed;
  for (const EffectPlace& place : places) freed.push_back(made.recorded.freed(place));
  std::vector<Trial> out = try_places(made.context(), freed);
  std::stable_sort(out.begin(), out.end(),
                   [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
  return out;
}

bool names(const SeveralCauses& several, EffectKind kind, const EffectPlace& place) {
  return std::any_of(several.causes.begin(), several.causes.end(), [&](const Cause& c) {
    return c.trial.kind == kind && c.trial.place == place;
  });
}

TEST(SeveralCauses, TwoSimultaneousOnesAreFoundTogether) {
  const HandMade made(records_of_two_causes());
  const std::vector<Trial> tried =
      tried_at(made, {test::in_frame(2), test::at_channel(0), test::at_channel(1)});
  const SeveralCauses several = several_causes(made.context(), tried, 1);
  ASSERT_EQ(several.causes.size(), 2U);
  EXPECT_TRUE(names(several, EffectKind::gain_error, test::at_channel(0)));
  EXPECT_TRUE(names(several, EffectKind::cubic_stiffness, test::in_frame(2)));
  EXPECT_NEAR(several.model.gain[0], kGain, kGainOff);
  ASSERT_EQ(several.model.effects.size(), 1U);
}

TEST(SeveralCauses, NoneIsChosenWithoutHeldOutRecords) {
  const HandMade made(records_of_one_cause());
  const std::vector<Trial> tried = tried_at(made, {test::at_channel(0)});
  EXPECT_FALSE(several_causes(made.context(), tried, 1).causes.empty());
  EXPECT_TRUE(several_causes(made.context(), tried, 2).causes.empty());
  EXPECT_TRUE(several_causes(made.context(), {}, 1).causes.empty());
}

TEST(SeveralCauses, ExcludedNamesAndExternalForcesAreNotChosen) {
  HandMade made(records_of_one_cause());
  std::vector<Trial> tried = tried_at(made, {test::at_channel(0)});
  std::erase_if(tried, [](const Trial& t) { return t.kind != EffectKind::gain_error; });
  ASSERT_FALSE(tried.empty());
  made.without = {EffectKind::gain_error};
  EXPECT_TRUE(several_causes(made.context(), tried, 1).causes.empty());
  made.without.clear();
  for (Trial& t : tried) t.kind = EffectKind::unmeasured_force;
  EXPECT_TRUE(several_causes(made.context(), tried, 1).causes.empty());
}

TEST(SeveralCauses, OneThatMakesAHeldOutRecordWorseIsNotChosen) {
  std::vector<Eigen::MatrixXd> records = test::records_with({}, {1, 2});
  records[0].col(0) *= 1 + kGain;  // of the training record alone
  const HandMade made(records);
  const std::vector<Trial> tried = tried_at(made, {test::at_channel(0)});
  EXPECT_TRUE(several_causes(made.context(), tried, 1).causes.empty());
}

/// With other causes, the best law may be one that was second at its place: hysteresis of another
/// name than the one that got a free run there.
TEST(SeveralCauses, HysteresisWithoutAFreeRunMayBeChosen) {
  const HandMade made(test::records_with(
      {test::effect_of(EffectKind::bouc_wen, test::in_frame(2), {4e6, 0.004, 1, 0.5})}, {1, 2}));
  std::vector<Trial> tried = tried_at(made, {test::in_frame(2)});
  const auto of = [&](EffectKind kind) {
    return *std::find_if(tried.begin(), tried.end(),
                         [&](const Trial& t) { return t.kind == kind; });
  };
  Trial round = of(EffectKind::bouc_wen), sharp = of(EffectKind::bilinear_hysteresis);
  round.outcome = TrialOutcome::screened_out;
  EXPECT_TRUE(several_causes(made.context(), {round}, 1).causes.empty());
  sharp.outcome = TrialOutcome::fitted;
  const SeveralCauses several = several_causes(made.context(), {sharp, round}, 1);
  ASSERT_EQ(several.causes.size(), 1U);
  EXPECT_EQ(several.causes.front().trial.kind, EffectKind::bouc_wen);
}

}  // namespace several_causes_test
}  // namespace framewatch::estimator
