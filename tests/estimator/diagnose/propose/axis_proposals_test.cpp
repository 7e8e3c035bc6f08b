#include <algorithm>

#include <gtest/gtest.h>

#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/propose.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace axis_proposals_test {

using test::Recorded;

constexpr int kChannel = 1;  // x-parallel frame y2, floor 1
constexpr double kGainOff = 0.01, kRounding = 1e-12;
constexpr double kTurned = -1.5;   // gain below which an axis is turned round
constexpr double kDelayOff = 0.2;  // relative: a start value is linear in the delay

std::vector<Proposal> proposals_for(const Recorded& recorded) {
  return propose(recorded.fitter, recorded.freed(test::at_channel(kChannel)), 0);
}

const Proposal* find(const std::vector<Proposal>& proposals, EffectKind kind) {
  const auto at = std::find_if(proposals.begin(), proposals.end(),
                               [&](const Proposal& p) { return p.kind == kind; });
  return at == proposals.end() ? nullptr : &*at;
}

TEST(AxisProposals, GainStartsWhereTheReadingIs) {
  for (const double gain : {-0.3, 0.08, 0.5}) {
    std::vector<Eigen::MatrixXd> records = test::records_with({});
    records[0].col(kChannel) *= 1 + gain;
    const Recorded recorded(records);
    const std::vector<Proposal> proposals = proposals_for(recorded);
    const Proposal* p = find(proposals, EffectKind::gain_error);
    ASSERT_NE(p, nullptr) << gain;
    EXPECT_NEAR(p->model.gain[kChannel], gain, kGainOff);
    EXPECT_EQ(p->model.free_gain, std::vector<int>{kChannel});
    EXPECT_TRUE(p->model.free_clock.empty());
  }
}

TEST(AxisProposals, AnAxisTurnedRoundIsOfWrongPolarity) {
  std::vector<Eigen::MatrixXd> records = test::records_with({});
  records[0].col(kChannel) *= -1;
  const Recorded recorded(records);
  const std::vector<Proposal> proposals = proposals_for(recorded);
  EXPECT_EQ(find(proposals, EffectKind::gain_error), nullptr);
  const Proposal* p = find(proposals, EffectKind::polarity);
  ASSERT_NE(p, nullptr);
  EXPECT_LT(p->model.gain[kChannel], kTurned);
}

TEST(AxisProposals, ClockStartsAtTheDelay) {
  for (const int late : {-2, 1, 2}) {
    std::vector<Eigen::MatrixXd> records = test::records_with({});
    const Eigen::Index rows = records[0].rows();
    const Eigen::VectorXd read = records[0].col(kChannel);
    for (Eigen::Index i = 0; i < rows; ++i)
      records[0](i, kChannel) = read[std::clamp<Eigen::Index>(i - late, 0, rows - 1)];
    const Recorded recorded(records);
    const std::vector<Proposal> proposals = proposals_for(recorded);
    const Proposal* p = find(proposals, EffectKind::time_shift);
    ASSERT_NE(p, nullptr) << late;
    EXPECT_NEAR(p->model.clock_s[kChannel] / (late / test::kRate_hz), 1, kDelayOff);
    EXPECT_EQ(p->model.free_clock, std::vector<int>{kChannel});
    EXPECT_TRUE(p->model.free_gain.empty());
  }
}

TEST(AxisProposals, AnAxisMayBeTurnedTowardThoseAcrossItOnItsFloor) {
  const Recorded recorded(test::records_with({}));
  std::vector<int> across;
  for (const Proposal& p : proposals_for(recorded)) {
    if (p.kind != EffectKind::misalignment) continue;
    EXPECT_EQ(p.place.kind, PlaceKind::channel_pair);
    EXPECT_EQ(p.place.channel, kChannel);
    EXPECT_NEAR(p.model.effects.back().parameters[0].plain(), 0, kRounding);
    across.push_back(p.place.with_channel);
  }
  EXPECT_EQ(across, (std::vector<int>{2, 3}));
}

TEST(AxisProposals, OnlyAReadingWithManyEqualPeaksIsClipped) {
  struct Clipped {
    double share;  ///< of the largest reading at which it is cut off
    bool proposed;
  };
  for (const Clipped& c : {Clipped{1, false}, Clipped{0.4, true}}) {
    std::vector<Eigen::MatrixXd> records = test::records_with({});
    const double level = c.share * records[0].col(kChannel).cwiseAbs().maxCoeff();
    records[0].col(kChannel) = records[0].col(kChannel).cwiseMax(-level).cwiseMin(level).eval();
    const Recorded recorded(records);
    const std::vector<Proposal> proposals = proposals_for(recorded);
    const Proposal* p = find(proposals, EffectKind::clipping);
    ASSERT_EQ(p != nullptr, c.proposed) << c.share;
    if (p) {
      EXPECT_EQ(p->model.effects.back().form, LawForm::clipped);
    }
  }
}

}  // namespace axis_proposals_test
}  // namespace framewatch::estimator
