// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/node_proposals.h"
#include "estimator/diagnose/propose/propose.h"
#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace node_proposals_test {

using test::Recorded;

constexpr int kFrame = 2;
constexpr double kMassOff = 0.3, kFrequencyOff = 0.02;  // of an oscillator's start values
constexpr double kForceOff = 0.1, kForceHzOff = 2e-3, kOnsetOff_s = 0.5;

/// Proposals for an arbitrary force in a frame, or at its floor.
struct AtNode {
  Recorded recorded;
  std::vector<Proposal> proposals;

  explicit AtNode(const Effect& effect)
      : recorded(test::records_with({effect})),
        proposals(propose(recorded.fitter, recorded.freed(test::in_frame(kFrame)), 0)) {}

  const ModelEffect* of_form(LawForm form) const {
    for (const Proposal& p : proposals)
      if (p.model.effects.back().form == form) return &p.model.effects.back();
    return nullptr;
  }
};

TEST(NodeProposals, ProposeAHiddenOscillatorFirst) {
  constexpr double kMass_kg = 3300, kFrequency_hz = 2.5;
  const AtNode at(test::effect_of(EffectKind::tuned_mass_damper, test::at_node(kFrame),
                                  {kMass_kg, kFrequency_hz, 0.05}));
  const Proposal& best = at.proposals.front();
  EXPECT_EQ(best.kind, EffectKind::tuned_mass_damper);
  EXPECT_EQ(best.place, test::at_node(kFrame));
  const std::vector<LawParameter>& parameters = best.model.effects.back().parameters;
  EXPECT_NEAR(parameters[0].plain() / kMass_kg, 1, kMassOff);
  EXPECT_NEAR(parameters[1].plain() / kFrequency_hz, 1, kFrequencyOff);
}

TEST(NodeProposals, ProposeAHarmonicForceWithFrequencySizeAndOnset) {
  constexpr double kForce_n = 3000, kHz = 3.3, kFrom_s = 4;
  const AtNode at(test::effect_of(EffectKind::unmeasured_force, test::at_node(kFrame),
                                  {kForce_n, kHz, 0.4, 0, 0.1, 10, 1, kFrom_s}));
  const ModelEffect* harmonic = at.of_form(LawForm::harmonic);
  ASSERT_NE(harmonic, nullptr);
  EXPECT_NEAR(harmonic->parameters[0].plain() / kHz, 1, kForceHzOff);
  const std::vector<LawParameter>& waves = harmonic->record_parameters.front();
  EXPECT_NEAR(std::hypot(waves[0].plain(), waves[1].plain()) / kForce_n, 1, kForceOff);
  EXPECT_NEAR(harmonic->onset_s.front(), kFrom_s, kOnsetOff_s);
  // It explains far more than any law of the frame.
  const auto misfit = [&](auto&& wanted) {
    double least = 1e300;
    for (const Proposal& p : at.proposals)
      if (wanted(p.model.effects.back())) least = std::min(least, p.misfit);
    return least;
  };
  EXPECT_LT(misfit([](const ModelEffect& e) { return e.form == LawForm::harmonic; }),
            0.2 * misfit([](const ModelEffect& e) { return e.element_law(); }));
}

TEST(NodeProposals, FindTheFrequencyOfADominantHarmonicForce) {
  constexpr double kForce_n = 1e5, kHz = 2.3;
  const AtNode at(test::effect_of(EffectKind::unmeasured_force, test::at_node(kFrame),
                                  {kForce_n, kHz, 0.4, 0, 0.1, 10, 1, 0}));
  const ModelEffect* harmonic = at.of_form(LawForm::harmonic);
  ASSERT_NE(harmonic, nullptr);
  EXPECT_NEAR(harmonic->parameters[0].plain() / kHz, 1, kForceHzOff);
}

TEST(NodeProposals, ProposeAFreeForceIfItContinuesAtRest) {
  const Recorded recorded(test::records_with({}));
  const Localisation place = recorded.freed(test::in_frame(kFrame));
  const RecordSegment& s = recorded.segments.front();
  const auto offered = [&](const Eigen::VectorXd& force) {
    std::vector<NeededSignal> needed = needed_signals(recorded.fitter, place);
    needed.front().force += band_of(force, s, 1);
    std::vector<Proposal> out;
    add_node_proposals(recorded.fitter, place, needed, test::at_node(kFrame), out);
    return std::any_of(out.begin(), out.end(), [](const Proposal& p) {
      return p.model.effects.back().form == LawForm::broadband;
    });
  };
  Random random(4);
  Eigen::VectorXd stationary(s.intervals());
  for (double& f : stationary) f = 2e4 * random.normal();
  EXPECT_TRUE(offered(stationary));
  EXPECT_FALSE(offered(1e-4 * stationary)) << "not above the noise";
  // Only where the ground shakes: a law of the building can do this.
  Eigen::VectorXd with_ground = stationary;
  for (Eigen::Index i = 0; i < with_ground.size(); ++i)
    with_ground[i] *=
        s.accel.row(i).tail(2).squaredNorm() / s.accel.rightCols(2).rowwise().squaredNorm().mean();
  EXPECT_FALSE(offered(with_ground));
}

TEST(NodeProposals, TreatOnlyFirstStoryElementsAsNodes) {
  EffectPlace panel;
  panel.kind = PlaceKind::panel;
  panel.story = 1;
  panel.panel = 0;
  const Recorded recorded(test::records_with({}));
  for (const EffectPlace& place : {test::in_frame(kFrame), panel}) {
    const std::vector<Proposal> proposals = propose(recorded.fitter, recorded.freed(place), 0);
    const bool oscillator = std::any_of(proposals.begin(), proposals.end(), [](const Proposal& p) {
      return p.kind == EffectKind::tuned_mass_damper;
    });
    EXPECT_EQ(oscillator, place.kind == PlaceKind::frame);
  }
}

}  // namespace node_proposals_test
}  // namespace framewatch::estimator
