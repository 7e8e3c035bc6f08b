#include <cmath>

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

TEST(LinearProposals, ACrossingGetsAMassThatMayBeMissingAtMost) {
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

TEST(LinearProposals, ABuildingThatTurnsIsSoftNotNegative) {
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

TEST(LinearProposals, TheWhichthPlaceOfAPairIsMeant) {
  const Recorded recorded(test::records_with({}));
  const Model model = recorded.linear().model;
  Localisation pair = recorded.freed(test::at_crossing(1));
  pair.candidate_places.push_back(recorded.freed(test::at_channel(3)).candidate_places.front());
  EXPECT_EQ(propose(recorded.fitter, pair, 0).front().kind, EffectKind::extra_mass);
  EXPECT_EQ(propose(recorded.fitter, pair, 1).front().kind, EffectKind::gain_error);
}

/// Two stories, what is proposed for the upper floor's node of the first frame.
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

/// Whether it is proposed first, about as large as it is.
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

TEST(LinearProposals, ASpringToTheGroundIsSized) {
  expect_first_upstairs(EffectKind::added_spring, 6e3);
}

TEST(LinearProposals, ADamperToTheGroundIsSized) {
  expect_first_upstairs(EffectKind::added_damper, 150);
}

}  // namespace propose_test
}  // namespace framewatch::estimator
