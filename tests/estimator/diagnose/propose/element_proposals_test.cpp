// SPDX-License-Identifier: MIT
#include <algorithm>

#include <cmath>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/propose/element_proposals.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/propose.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace element_proposals_test {

using test::Recorded;

constexpr int kFrame = 2;           // of 8e6 N/m; it deforms by about 16 mm, 0.2 m/s
constexpr double kSizeOff = 0.4;    // of a start value, because the scalar fit uses noisy motion
constexpr double kMinShare = 0.05;  // of the design, the smallest stiffness that a proposal leaves

bool dissipates(LawForm form) {
  return is_hysteretic(form) || form == LawForm::friction || form == LawForm::power_damping;
}

/// A law hidden in the frame, and the family that should fit its force best.
struct HiddenLaw {
  EffectKind kind;
  std::vector<double> values;
  LawForm form;
  EffectKind proposed;

  friend void PrintTo(const HiddenLaw& law, std::ostream* out) { *out << name_of(law.kind); }
};

/// Returns the first parameter of the catalog's law for a proposed law.
double size_of(const ModelEffect& e) {
  const double amplitude = e.parameters[0].plain();
  if (e.form == LawForm::power) return amplitude / std::pow(e.deformation, e.parameters[1].plain());
  if (e.form == LawForm::power_damping)
    return amplitude / std::pow(e.rate, e.parameters[1].plain());
  return amplitude;
}

class LawInAFrame : public testing::TestWithParam<HiddenLaw> {};

TEST_P(LawInAFrame, IsProposedFirstInItsFrame) {
  const HiddenLaw& law = GetParam();
  Effect effect = make_effect(law.kind, test::in_frame(kFrame));
  std::copy(law.values.begin(), law.values.end(), effect.values.begin());
  const Recorded recorded(test::records_with({effect}));
  const std::vector<Proposal> proposals = propose(recorded.fitter, recorded.freed(effect.place), 0);
  ASSERT_FALSE(proposals.empty());
  const Proposal& best = proposals.front();
  const ModelEffect& chosen = best.model.effects.back();
  EXPECT_EQ(chosen.form, law.form);
  EXPECT_EQ(name_of(best.kind), name_of(law.proposed));
  EXPECT_EQ(best.place, effect.place);
  EXPECT_NEAR(size_of(chosen) / law.values.front(), 1, kSizeOff);
  EXPECT_TRUE(
      std::is_sorted(proposals.begin(), proposals.end(),
                     [](const Proposal& a, const Proposal& b) { return a.misfit < b.misfit; }));
  for (const Proposal& p : proposals) {
    // The force follows the motion, so it is not an arbitrary force.
    EXPECT_NE(p.model.effects.back().form, LawForm::broadband);
    if (dissipates(p.model.effects.back().form)) {
      EXPECT_GE(p.model.effects.back().parameters[0].plain(), 0) << name_of(p.kind);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Catalogue, LawInAFrame,
    testing::Values(
        HiddenLaw{
            EffectKind::cubic_stiffness, {2.25e10}, LawForm::power, EffectKind::cubic_stiffness},
        HiddenLaw{EffectKind::cubic_stiffness, {-8e9}, LawForm::power, EffectKind::cubic_stiffness},
        HiddenLaw{
            EffectKind::quadratic_stiffness, {3.5e8}, LawForm::power, EffectKind::cubic_stiffness},
        HiddenLaw{EffectKind::bilinear_hysteresis,
                  {4e6, 4e-3},
                  LawForm::hysteresis,
                  EffectKind::bilinear_hysteresis},
        HiddenLaw{
            EffectKind::bouc_wen, {4e6, 4e-3, 1, 0.5}, LawForm::hysteresis, EffectKind::bouc_wen},
        HiddenLaw{EffectKind::pinching,
                  {4.8e6, 3e-3, 2, 0.5, 0.9, 0.2},
                  LawForm::pinched,
                  EffectKind::pinching},
        HiddenLaw{EffectKind::pinching,
                  {4.8e6, 4e-3, 2, 0.5, 0, 0.2, 0, 0, 0, 0, 0, 1, 1e-3},
                  LawForm::slack,
                  EffectKind::pinching},
        HiddenLaw{EffectKind::bilinear_hysteresis,
                  {4.8e6, 2e-3, 0, 0, 0, 1, 0.4},
                  LawForm::peak_oriented,
                  EffectKind::bilinear_hysteresis},
        HiddenLaw{EffectKind::bilinear_hysteresis,
                  {4.8e6, 2e-3, 0, 0, 0, 0, 0, 0.5},
                  LawForm::sliders,
                  EffectKind::bilinear_hysteresis},
        HiddenLaw{EffectKind::coulomb_friction,
                  {1.26e4, 4e-3},
                  LawForm::friction,
                  EffectKind::coulomb_friction},
        HiddenLaw{EffectKind::quadratic_damping,
                  {6e5},
                  LawForm::power_damping,
                  EffectKind::quadratic_damping},
        HiddenLaw{EffectKind::one_sided_gap,
                  {8e6, 6.3e-3, 1},
                  LawForm::gap_positive,
                  EffectKind::one_sided_gap},
        HiddenLaw{EffectKind::one_sided_gap,
                  {8e6, 6.3e-3, -1},
                  LawForm::gap_negative,
                  EffectKind::one_sided_gap},
        HiddenLaw{
            EffectKind::two_sided_gap, {4e6, 8e-3}, LawForm::gap_both, EffectKind::two_sided_gap},
        HiddenLaw{EffectKind::one_sided_gap,
                  {8e6, 6.3e-3, 1, 3.2e5},
                  LawForm::gap_positive,
                  EffectKind::one_sided_gap},
        HiddenLaw{EffectKind::two_sided_gap,
                  {4e6, 8e-3, 2e5},
                  LawForm::gap_both,
                  EffectKind::two_sided_gap},
        HiddenLaw{
            EffectKind::stiffness_drop, {-1.6e6, 6}, LawForm::changing, EffectKind::stiffness_drop},
        HiddenLaw{EffectKind::stiffness_drift,
                  {-2.4e6, 3, 8},
                  LawForm::changing,
                  EffectKind::stiffness_drift}),
    [](const testing::TestParamInfo<HiddenLaw>& one) {
      return std::string(name_of(one.param.kind)) + "_" + std::to_string(one.index);
    });

/// The needed signal of an element in a record that hides nothing. Tests replace its force.
struct QuietElement {
  Recorded recorded{test::records_with({})};
  Localisation place;
  std::vector<NeededSignal> needed;

  explicit QuietElement(const EffectPlace& where)
      : place(recorded.freed(where)), needed(needed_signals(recorded.fitter, place)) {}
  std::vector<Proposal> proposals() const {
    return element_proposals(recorded.fitter, place, needed,
                             place.candidate_places.front().element);
  }
};

TEST(ElementProposals, ProposeNoDissipativeLawForADrivingForce) {
  QuietElement frame(test::in_frame(kFrame));
  NeededSignal& needed = frame.needed.front();
  const RecordSegment& s = frame.recorded.segments.front();
  needed.force = -band_of(needed.v_t.array().tanh().matrix(), s, frame.recorded.fitter.ratio(0));
  int others = 0;
  for (const Proposal& p : frame.proposals()) {
    EXPECT_FALSE(dissipates(p.model.effects.back().form) &&
                 p.model.effects.back().parameters[0].plain() < 0)
        << name_of(p.kind);
    others += !dissipates(p.model.effects.back().form);
  }
  EXPECT_GE(others, 6);  // power, three gaps, two changes
}

TEST(ElementProposals, ProposeNoStiffnessBelowTheLeastShare) {
  QuietElement frame(test::in_frame(kFrame));
  const int element = frame.place.candidate_places.front().element;
  const double design = frame.recorded.plant.design[element];
  frame.needed.front().force = -10 * design * frame.needed.front().d;
  const std::vector<Proposal> proposals = frame.proposals();
  ASSERT_FALSE(proposals.empty());
  for (const Proposal& p : proposals)
    EXPECT_GE(p.model.theta[element], 0.999 * kMinShare * design) << name_of(p.kind);
}

TEST(ElementProposals, AssignALinearForceToStiffnessAndDamping) {
  constexpr double kMoreStiffness = 3e5, kMoreDamping = 2e4, kNear = 0.01;
  QuietElement frame(test::in_frame(kFrame));
  NeededSignal& needed = frame.needed.front();
  const RecordSegment& s = frame.recorded.segments.front();
  const std::vector<Eigen::VectorXcd> columns = linear_columns(needed, s.w);
  needed.force = kMoreStiffness * columns[0] + kMoreDamping * columns[1];
  const int element = frame.place.candidate_places.front().element;
  const auto elements = static_cast<int>(frame.recorded.plant.element_count());
  const Eigen::VectorXd& before = frame.place.model.theta;
  for (const Proposal& p : frame.proposals()) {
    if (p.model.effects.back().form != LawForm::power) continue;
    EXPECT_NEAR((p.model.theta[element] - before[element]) / kMoreStiffness, 1, kNear);
    EXPECT_NEAR((p.model.theta[element + elements] - before[element + elements]) / kMoreDamping, 1,
                kNear);
  }
}

TEST(ElementProposals, ProposePinchingOnlyForFrames) {
  EffectPlace panel;
  panel.kind = PlaceKind::panel;
  panel.story = 1;
  panel.panel = 0;
  for (const EffectPlace& place : {test::in_frame(kFrame), panel}) {
    const std::vector<Proposal> proposals = QuietElement(place).proposals();
    const bool pinched = std::any_of(proposals.begin(), proposals.end(), [](const Proposal& p) {
      return p.kind == EffectKind::pinching;
    });
    EXPECT_EQ(pinched, place.kind == PlaceKind::frame);
  }
}

constexpr double kOnsetOff = 0.02;   // of the record
constexpr double kLengthOff = 0.35;  // of the duration: the coarse search has three

/// Two records of a frame whose force gains a share of stiffness: in the first from from_s on, over
/// length_s; in the second all the time.
struct Changing {
  Recorded recorded{test::records_with({}, {1, 2})};
  std::vector<NeededSignal> needed;
  ModelEffect start;

  Changing(double from_s, double length_s, bool also_in_second) {
    constexpr double kChange_npm = -1e6;
    const Localisation place = recorded.freed(test::in_frame(kFrame));
    needed = needed_signals(recorded.fitter, place);
    start.form = LawForm::changing;
    start.place = test::in_frame(kFrame);
    start.parameters = {linear_parameter(kChange_npm, 1e4)};
    for (std::size_t r = 0; r < needed.size(); ++r) {
      const RecordSegment& s = recorded.segments[r];
      const int ratio = recorded.fitter.ratio(r);
      const double from = r == 0 ? from_s : also_in_second ? -1 : 1e6;
      const LawValues law{LawForm::changing, {kChange_npm, from, r == 0 ? length_s : 0.05}, 1, 1};
      needed[r].force =
          band_of(law_force(law, needed[r].d_t, needed[r].v_t, 1 / (s.rate_hz * ratio)), s, ratio);
    }
  }

  std::vector<LawParameter> times(std::size_t record, bool sudden) const {
    return timed_change(recorded.fitter, needed, start, sudden).record_parameters[record];
  }
  double seconds() const { return recorded.segments.front().seconds(); }
};

TEST(TimedChange, FindsTheTimeOfADrop) {
  for (const double from_s : {2.0, 9.3, 15.0}) {
    const Changing c(from_s, 0.05, true);
    const std::vector<LawParameter> times = c.times(0, true);
    EXPECT_NEAR(times[0].plain(), from_s, kOnsetOff * c.seconds());
    EXPECT_FALSE(times[1].free);
  }
}

TEST(TimedChange, FindsTheTimeOfADriftAndFreesItsDuration) {
  constexpr double kFrom_s = 4, kDuration_s = 13;
  const Changing c(kFrom_s, kDuration_s, true);
  const std::vector<LawParameter> times = c.times(0, false);
  EXPECT_NEAR(times[0].plain(), kFrom_s, 2 * kOnsetOff * c.seconds());
  EXPECT_NEAR(times[1].plain() / kDuration_s, 1, kLengthOff);
  EXPECT_TRUE(times[1].free);
}

TEST(TimedChange, CoversAWholeRecordAfterTheChange) {
  // Alone it could be a change of another stiffness; the first record decides.
  constexpr double kStillAtRest_s = 1;
  const Changing c(10, 0.05, true);
  EXPECT_LT(c.times(1, true)[0].plain(), kStillAtRest_s);
}

TEST(TimedChange, StartsAtTheEndOfARecordBeforeTheChange) {
  constexpr double kMotionEnds_s = 15;
  const Changing c(10, 0.05, false);
  EXPECT_GT(c.times(1, true)[0].plain(), kMotionEnds_s);
}

}  // namespace element_proposals_test

}  // namespace framewatch::estimator
