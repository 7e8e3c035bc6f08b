// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/damping_form.h"

#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/verdict/diagnose.h"
#include "tests/estimator/diagnose/effect_of.h"
#include "tests/estimator/diagnose/hidden_effect.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace damping_form_test {

constexpr double kRatios[] = {0.02, 0.01, 0.03, 0.015, 0.02, 0.01, 0.025, 0.02};

/// Returns two stories whose dashpots give a tenth of the damping.
test::Small two_stories() {
  test::Small out = test::tower(2);
  out.truth.tail(out.table.elements()) *= 0.1;
  return out;
}

EffectPlace mode_place(int mode) {
  EffectPlace out;
  out.kind = PlaceKind::mode;
  out.mode = mode;
  return out;
}

/// Returns a separate ratio for every mode.
std::vector<Effect> ratios() {
  std::vector<Effect> out;
  for (const double ratio : kRatios) {
    out.push_back(make_effect(EffectKind::modal_damping, mode_place(1 + int(out.size()))));
    out.back().set("damping_ratio", ratio);
  }
  return out;
}

/// Returns alpha M as dashpots from all floors to the ground.
std::vector<Effect> proportional_to_mass(test::Small& small, double alpha_ps) {
  std::vector<Effect> out;
  const Structure& s = small.structure;
  for (int f = 0; f < s.frames(); ++f) {
    small.truth[small.table.frame_damping(1, f)] += alpha_ps * s.frame_mass(1, f);
    EffectPlace place;
    place.kind = PlaceKind::node_pair;
    place.story = 2;
    place.frame = f;
    out.push_back(make_effect(EffectKind::added_damper, place));
    out.back().set("c_nspm", alpha_ps * s.frame_mass(2, f));
  }
  return out;
}

Model true_model(const test::Small& small) {
  Model out = initial_model(small.plant());
  out.theta = small.truth;
  add_modal_damping(small.plant(), out);
  for (std::size_t mode = 0; mode < out.effects.size(); ++mode)
    out.effects[mode].parameters[0].value = kRatios[mode];
  return out;
}

/// Returns the damping ratio of every mode, from dashpots and modal damping.
Eigen::VectorXd ratios_of(const Plant& plant, const Model& model) {
  const ModelModes modes = modes_of(plant, model);
  const Eigen::MatrixXd& act = plant.building.act;
  const Eigen::MatrixXd damping =
      act * model.theta.tail(plant.element_count()).asDiagonal() * act.transpose() +
      modal_damping(plant, model);
  return (modes.shapes.transpose() * damping * modes.shapes).diagonal().cwiseQuotient(2 * modes.w);
}

Diagnosis diagnosed(const test::Small& small, const std::vector<Effect>& effects) {
  const Plant plant = small.plant();
  const auto segments = small.segments({small.record(effects, 1), small.record(effects, 2)});
  return diagnose(plant, segments, test::held_out_from(1));
}

TEST(DampingForm, AcceptsARatioForEveryMode) {
  const test::Small small = two_stories();
  const Diagnosis d = diagnosed(small, ratios());
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_FALSE(modal_damping_effects(d.model).empty());
  const Eigen::VectorXd found = ratios_of(small.plant(), d.model),
                        true_ratios = ratios_of(small.plant(), true_model(small));
  for (Eigen::Index mode = 0; mode < found.size(); ++mode)
    EXPECT_NEAR(found[mode], true_ratios[mode], 0.1 * true_ratios[mode]) << mode + 1;
}

TEST(DampingForm, AcceptsMassProportionalDamping) {
  test::Small small = two_stories();
  const std::vector<Effect> effects = proportional_to_mass(small, 0.8);
  const Diagnosis d = diagnosed(small, effects);
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_FALSE(modal_damping_effects(d.model).empty());
}

TEST(DampingForm, DashpotsBetweenFloorsNeedNoModalRatios) {
  const Diagnosis d = diagnosed(test::tower(2), {});
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_TRUE(modal_damping_effects(d.model).empty());
}

TEST(DampingForm, ReportsASingleDashpotToTheGround) {
  EffectPlace place;
  place.kind = PlaceKind::node_pair;
  place.story = 2;
  place.frame = 1;
  Effect damper = make_effect(EffectKind::added_damper, place);
  damper.set("c_nspm", 2e4);
  const Diagnosis d = diagnosed(test::tower(2), {damper});
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::added_damper);
  EXPECT_EQ(d.effects[0].chosen.place, place);
  EXPECT_TRUE(modal_damping_effects(d.model).empty());
}

TEST(DampingForm, DoesNotFreeRatiosTwice) {
  const test::Small small = two_stories();
  const Plant plant = small.plant();
  const Effect law = test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e8});
  const auto segments = small.segments({small.record({law}, 1)});
  const Fitter fitter(plant, segments, {});
  Model start = initial_model(plant);
  add_modal_damping(plant, start);
  FitResult with = with_free_damping(fitter, fitter.fit(start, {}, {}));
  ASSERT_TRUE(with.good);
  EXPECT_FALSE(with_free_damping(fitter, with).good);
  with.model.effects.front().parameters[0].free = false;
  EXPECT_TRUE(with_free_damping(fitter, with).good);
}

TEST(DampingForm, KeepsTheNameOfALawBesideIt) {
  const test::Small small = two_stories();
  std::vector<Effect> effects = ratios();
  effects.push_back(test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e8}));
  const Diagnosis d = diagnosed(small, effects);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_EQ(d.effects[0].chosen.place, test::in_frame(1));
  EXPECT_EQ(d.verdict, Verdict::explained);
}

}  // namespace damping_form_test
}  // namespace framewatch::estimator
