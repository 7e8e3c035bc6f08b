// SPDX-License-Identifier: MIT
#include <cmath>

#include <algorithm>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/model/make_plant.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/propose.h"
#include "tests/estimator/diagnose/hidden_effect.h"
#include "tests/support/example_effects.h"

namespace framewatch::estimator {
namespace propose_test {

using test::Recorded;

TEST(LinearProposals, ProposeAMassAtACrossingBoundedBelow) {
  const Recorded recorded(test::records_with({}));
  const std::vector<Proposal> proposals =
      propose(recorded.fitter, recorded.freed(test::at_crossing(1)), 0);
  ASSERT_EQ(proposals.size(), 1U);
  EXPECT_EQ(proposals[0].kind, EffectKind::extra_mass);
  EXPECT_EQ(proposals[0].place, test::at_crossing(1));
  const LawParameter& mass = proposals[0].model.effects.back().parameters[0];
  EXPECT_DOUBLE_EQ(mass.low, -recorded.plant.structure.node_mass[0]);
  EXPECT_GT(mass.plain(), 0);
}

TEST(LinearProposals, ProposeAPositiveStiffnessForATurningBuilding) {
  const Recorded recorded(test::records_with({}));
  EffectPlace building;
  building.kind = PlaceKind::building;
  building.direction = Direction::y;
  const std::vector<Proposal> proposals = propose(recorded.fitter, recorded.freed(building), 0);
  ASSERT_EQ(proposals.size(), 2U);
  EXPECT_EQ(proposals[0].kind, EffectKind::base_rocking);
  EXPECT_EQ(proposals[1].kind, EffectKind::frame_bending);
  for (const Proposal& p : proposals) {
    const LawParameter& flexibility = p.model.effects.back().parameters[0];
    EXPECT_GT(flexibility.plain(), 0);
    EXPECT_DOUBLE_EQ(flexibility.low, 0);
    EXPECT_EQ(p.model.effects.back().place, building);
  }
}

TEST(LinearProposals, UseTheGivenPlaceOfAPair) {
  const Recorded recorded(test::records_with({}));
  const Model model = recorded.linear().model;
  Localisation pair = recorded.freed(test::at_crossing(1));
  pair.candidate_places.push_back(recorded.freed(test::at_channel(3)).candidate_places.front());
  EXPECT_EQ(propose(recorded.fitter, pair, 0).front().kind, EffectKind::extra_mass);
  EXPECT_EQ(propose(recorded.fitter, pair, 1).front().kind, EffectKind::gain_error);
}

/// Returns the proposals for the upper floor's node of the first frame of two stories.
std::vector<Proposal> proposals_upstairs(const Effect& effect) {
  constexpr double kRate_hz = 100, kSeconds = 24, kNoise_mps2 = 0.005;
  const test::TableModel model = test::table_model();
  const ParameterTable table = model.table();
  ResponseStream stream(model.structure, table, model.theta, test::oblique_motion(3), {kRate_hz},
                        {}, {}, {effect});
  Random random(17);
  const int dofs = model.structure.stories * model.structure.frames();
  Eigen::MatrixXd accel(static_cast<Eigen::Index>(kSeconds * kRate_hz), dofs + 2);
  for (Eigen::Index i = 0; i < accel.rows(); ++i) {
    const Eigen::VectorXd& exact = stream.next();
    // The axes begin with the base.
    accel.row(i) << exact.tail(2).transpose(), exact.head(dofs).transpose();
    for (Eigen::Index a = 0; a < accel.cols(); ++a) accel(i, a) += kNoise_mps2 * random.normal();
  }
  const std::vector<double> hz = natural_frequencies_hz(model.structure, table, model.theta);
  const std::vector<RecordSegment> segments{
      make_segment(accel, kRate_hz, Eigen::VectorXd::Constant(dofs + 2, kNoise_mps2),
                   {0.4 * hz.front(), 1.5 * hz.back()})};
  const Plant plant = *make_plant(model.structure, model.axes, model.theta, kRate_hz);
  const Fitter fitter(plant, segments, {});
  const Model start = fitter.fit(initial_model(plant), {}, {}).model;
  EffectPlace node = test::at_node(effect.place.frame);
  node.story = 2;
  for (const CandidatePlace& candidate : candidate_places_of(plant, start))
    if (candidate.place == node)
      return propose(fitter, localise(fitter, start, {}, {candidate}, 5), 0);
  return {};
}

/// Expects it as the first proposal, with about its true size.
void expect_first_upstairs(EffectKind kind, double size) {
  constexpr double kSizeOff = 0.25;
  EffectPlace link = test::in_frame(0);
  link.kind = PlaceKind::node_pair;
  link.story = 2;
  const std::vector<Proposal> proposals = proposals_upstairs(test::effect_of(kind, link, {size}));
  ASSERT_FALSE(proposals.empty());
  EXPECT_EQ(name_of(proposals.front().kind), name_of(kind));
  ASSERT_EQ(proposals.front().place, link);
  EXPECT_NEAR(proposals.front().model.effects.back().parameters[0].plain() / size, 1, kSizeOff);
}

TEST(LinearProposals, EstimateASpringToTheGround) {
  expect_first_upstairs(EffectKind::added_spring, 6e3);
}

TEST(LinearProposals, EstimateADamperToTheGround) {
  expect_first_upstairs(EffectKind::added_damper, 150);
}

constexpr int kChannel = 1;  // x-parallel frame y2, floor 1
constexpr double kGainOff = 0.01, kRounding = 1e-12;
constexpr double kTurned = -1.5;   // gain below which the sign of an axis is reversed
constexpr double kDelayOff = 0.2;  // relative: a start value is linear in the delay

std::vector<Proposal> proposals_for(const Recorded& recorded) {
  return propose(recorded.fitter, recorded.freed(test::at_channel(kChannel)), 0);
}

const Proposal* find(const std::vector<Proposal>& proposals, EffectKind kind) {
  const auto at = std::find_if(proposals.begin(), proposals.end(),
                               [&](const Proposal& p) { return p.kind == kind; });
  return at == proposals.end() ? nullptr : &*at;
}

TEST(AxisProposals, GainStartsAtTheObservedReading) {
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

TEST(AxisProposals, ProposeWrongPolarityForAReversedAxis) {
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

TEST(AxisProposals, ProposeMisalignmentTowardCrossAxesOfTheFloor) {
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

TEST(AxisProposals, ProposeClippingOnlyForManyEqualPeaks) {
  struct Clipped {
    double share;  ///< of the largest reading at which it is clipped
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

}  // namespace propose_test

}  // namespace framewatch::estimator
