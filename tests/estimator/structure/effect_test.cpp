// SPDX-License-Identifier: MIT
#include "estimator/structure/effect.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "estimator/structure/structure.h"
#include "tests/support/example_effects.h"

namespace framewatch::estimator {
namespace effect_test {

using enum EffectKind;

TEST(EffectCatalogue, ListsEachKindOnceInOrder) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < effect_catalogue().size(); ++i) {
    const EffectDescription& d = effect_catalogue()[i];
    EXPECT_EQ(d.kind, static_cast<EffectKind>(i));
    EXPECT_TRUE(names.insert(d.name).second) << d.name;
    EXPECT_EQ(find_effect(d.name), d.kind);
    EXPECT_FALSE(d.places.empty() || d.equation.empty() || d.source.empty()) << d.name;
  }
  EXPECT_EQ(effect_catalogue().back().kind, swapped);
  EXPECT_EQ(find_effect("ghost"), std::nullopt);
}

/// A key stands for one quantity everywhere, so the option table has it once.
TEST(EffectCatalogue, AKeyHasOneUnit) {
  for (const EffectDescription& a : effect_catalogue())
    for (const EffectDescription& b : effect_catalogue())
      for (const EffectParameter& p : a.parameters)
        for (const EffectParameter& q : b.parameters)
          if (p.key == q.key) {
            EXPECT_EQ(p.unit, q.unit) << p.key;
          }
}

TEST(EffectPlaces, CoverEveryPlace) {
  const test::TableModel m = test::table_model();
  const auto count = [&](EffectKind kind) {
    return effect_places(kind, m.structure, m.axes).size();
  };
  EXPECT_EQ(count(cubic_stiffness), 8u + 2u) << "frame stories and panels";
  EXPECT_EQ(count(quadratic_damping), 8u);
  EXPECT_EQ(count(tuned_mass_damper), 8u);
  EXPECT_EQ(count(extra_mass), 8u);
  EXPECT_EQ(count(added_spring), 4u) << "second floor to the ground";
  EXPECT_EQ(count(one_sided_gap), 8u + 4u) << "frame stories, stops at the second floor";
  EXPECT_EQ(count(amplitude_dependence), 2u + 4u) << "directions and whole frames";
  EXPECT_EQ(count(base_rocking), 2u);
  EXPECT_EQ(count(modal_damping), 8u);
  EXPECT_EQ(count(floor_flexibility), 0u) << "the floors flex already";
  EXPECT_EQ(count(gain_error), 10u);
  EXPECT_EQ(count(swapped), 45u);
  EXPECT_EQ(count(misalignment), 2u + 2u * 8u) << "the other direction of the same floor";
  const test::TableModel rigid = test::table_model(FloorModel::rigid);
  EXPECT_EQ(effect_places(floor_flexibility, rigid.structure, rigid.axes).size(), 2u);
  EXPECT_EQ(effect_places(cubic_stiffness, rigid.structure, rigid.axes).size(), 8u);
}

TEST(EffectPlaces, OfAPlaneBuilding) {
  Structure s;
  s.stories = 3;
  s.frames_x = {"y1"};
  s.story_height = {3, 3, 3};
  s.node_mass = {1, 1, 1};
  EXPECT_EQ(effect_places(bouc_wen, s, {}).size(), 3u);
  EXPECT_EQ(effect_places(base_rocking, s, {}).size(), 1u);
  EXPECT_EQ(effect_places(added_damper, s, {}).size(), 3u) << "2-0, 3-0, 3-1";
  EXPECT_EQ(crossing_name(s, 0), "y1");
  EXPECT_TRUE(effect_places(gain_error, s, {}).empty());
}

TEST(EffectProblems, NameTheKeyAndTheRule) {
  const test::TableModel m = test::table_model();
  const auto first_problem = [&](const Effect& e) {
    const std::vector<Problem> found = find_problems(e, m.structure, m.axes);
    return found.empty() ? std::string("none") : found.front().field + "|" + found.front().message;
  };
  for (const EffectDescription& d : effect_catalogue()) {
    if (d.kind == floor_flexibility) continue;
    EXPECT_EQ(first_problem(test::example_effect(d.kind, m)), "none") << d.name;
  }
  Effect friction = test::example_effect(coulomb_friction, m);
  friction.set("v0_mps", 0);
  EXPECT_EQ(first_problem(friction), "v0_mps|coulomb_friction.v0_mps: must be > 0 m/s");
  friction = test::example_effect(coulomb_friction, m);
  friction.place.story = 3;
  EXPECT_EQ(first_problem(friction), "story|coulomb_friction.story: must be 1 to 2");
  Effect side = test::example_effect(one_sided_gap, m);
  side.set("side", 0.5);
  EXPECT_EQ(first_problem(side), "side|one_sided_gap.side: must be 1 or -1");
  Effect mode = test::example_effect(modal_damping, m);
  mode.place.mode = 9;
  EXPECT_EQ(first_problem(mode), "mode|modal_damping.mode: must be 1 to 8");
  Effect light = test::example_effect(extra_mass, m);
  light.set("mass_kg", -20);
  EXPECT_EQ(first_problem(light), "mass_kg|extra_mass.mass_kg: leaves the node without mass");
  Effect slips = test::example_effect(amplitude_dependence, m);
  slips.set("slip", 1);
  EXPECT_EQ(first_problem(slips), "none");
  slips.set("softening", -0.1);
  EXPECT_NE(first_problem(slips).find("softening: must not be below 0"), std::string::npos);
  Effect round = test::example_effect(bilinear_hysteresis, m);
  round.set("sharpness", 1);
  EXPECT_EQ(first_problem(round), "none");
  round.set("strength_loss", 0.1);
  EXPECT_NE(first_problem(round).find("strength_loss: must be 0 with sharpness"),
            std::string::npos);
  round.set("strength_loss", 0);
  round.set("sharpness", 0.1);
  EXPECT_EQ(first_problem(round),
            "sharpness|bilinear_hysteresis.sharpness: must be 0 or at least 0.2");
  Effect oriented = test::example_effect(bilinear_hysteresis, m);
  oriented.set("unloading", 0.5);
  EXPECT_EQ(first_problem(oriented),
            "unloading|bilinear_hysteresis.unloading: must be 0 without peak_oriented");
  oriented.set("peak_oriented", 1);
  EXPECT_EQ(first_problem(oriented), "none");
  oriented.set("spread", 0.5);
  EXPECT_EQ(first_problem(oriented),
            "spread|bilinear_hysteresis.spread: must be 0 with peak_oriented");
  oriented.set("spread", 0);
  oriented.set("asymmetry", -0.2);
  EXPECT_EQ(first_problem(oriented),
            "asymmetry|bilinear_hysteresis.asymmetry: must be 0 with peak_oriented");
  oriented.set("asymmetry", 0);
  oriented.set("peak_oriented", 0.5);
  EXPECT_EQ(first_problem(oriented),
            "peak_oriented|bilinear_hysteresis.peak_oriented: must be 0 or 1");
  Effect wrong = test::example_effect(cubic_stiffness, m);
  wrong.place.kind = PlaceKind::channel;
  EXPECT_NE(first_problem(wrong).find("cannot be at this kind of place"), std::string::npos);
  Effect short_of_values = test::example_effect(bouc_wen, m);
  short_of_values.values.pop_back();
  EXPECT_NE(first_problem(short_of_values).find("needs 7 values"), std::string::npos);
  Effect not_a_number = test::example_effect(cubic_stiffness, m);
  not_a_number.values[0] = std::nan("");
  EXPECT_NE(first_problem(not_a_number).find("must be finite"), std::string::npos);
}

}  // namespace effect_test
}  // namespace framewatch::estimator
