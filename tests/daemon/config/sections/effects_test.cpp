// SPDX-License-Identifier: MIT
#include "daemon/config/sections/effects.h"

#include <gtest/gtest.h>

#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation_truth.h"
#include "tests/support/example_effects.h"

namespace framewatch::daemon {
namespace effects_test {

std::string kBuilding() {
  return "config = \"" FRAMEWATCH_SOURCE_DIR
         "/configs/table_two_story.toml\"\nduration_s = 3\n[motion]\nlength_s = 3\n";
}

struct Reading {
  std::optional<Scenario> scenario;
  std::vector<ConfigProblem> problems;

  std::string all() const {
    std::string out;
    for (const ConfigProblem& p : problems) out += p.where + ": " + p.message + "\n";
    return out;
  }
  bool says(const std::string& where, const std::string& what) const {
    for (const ConfigProblem& p : problems)
      if (p.where.find(where) != std::string::npos && p.message.find(what) != std::string::npos)
        return true;
    return false;
  }
};

Reading read(const std::string& effects, const std::string& building = kBuilding()) {
  Reading out;
  out.scenario = read_scenario(building + effects, "/s.toml", out.problems);
  return out;
}

TEST(Effects, EveryEffectAtEveryPlaceSurvivesItsText) {
  for (const estimator::FloorModel floor :
       {estimator::FloorModel::flexible, estimator::FloorModel::rigid}) {
    const test::TableModel m = test::table_model(floor);
    std::vector<estimator::Effect> all;
    for (const estimator::EffectDescription& d : estimator::effect_catalogue())
      for (const estimator::EffectPlace& place : effect_places(d.kind, m.structure, m.axes)) {
        all.push_back(test::example_effect(d.kind, m));
        all.back().place = place;
        EXPECT_TRUE(find_problems(all.back(), m.structure, m.axes).empty()) << d.name;
      }
    const std::string text = effects_toml(all, m.structure, m.axes);
    std::vector<TextProblem> problems;
    const std::optional<TomlValue> document = parse_toml(text, problems);
    ASSERT_TRUE(document);
    const std::vector<estimator::Effect> back =
        read_effects(tables_of(*document, "effect", problems), m.structure, m.axes, problems);
    ASSERT_TRUE(problems.empty()) << problems.front().message;
    ASSERT_EQ(back.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(back[i].kind, all[i].kind);
      EXPECT_EQ(back[i].place, all[i].place) << place_text(all[i].place, m.structure, m.axes);
      EXPECT_EQ(back[i].values, all[i].values);
    }
  }
}

TEST(Effects, EveryMistakeIsReportedWithItsLine) {
  const Reading r = read(R"([[effect]]
kind = "cubic_stifness"
[[effect]]
kind = "cubic_stiffness"
story = 5
frame = "y9"
k3_npm3 = 1e7
gap_m = 3
foo = 2
[[effect]]
kind = "coulomb_friction"
story = 1
frame = "y1"
direction = "y"
fc_n = -2
[[effect]]
kind = "swapped"
channel = "F1-Y1"
with_channel = "F1-Y1"
[[effect]]
kind = "added_spring"
story = 2
to_story = 1
frame = "y1"
k_npm = 1
[[effect]]
kind = "base_rocking"
kr_nmprad = "stiff"
[[effect]]
kind = "floor_flexibility"
story = 1
gk_nprad = 1e4
gc_nsprad = 1
)");
  EXPECT_FALSE(r.scenario);
  EXPECT_TRUE(r.says(":6:", "did you mean \"cubic_stiffness\"?")) << r.all();
  EXPECT_TRUE(r.says(":9:", "must be 1 to 2")) << r.all();
  EXPECT_TRUE(r.says(":10:", "did you mean \"y1\"?")) << r.all();
  EXPECT_TRUE(r.says(":12:", "no key of cubic_stiffness")) << r.all();
  EXPECT_TRUE(r.says(":13:", "unknown key foo")) << r.all();
  EXPECT_TRUE(r.says(":18:", "frame y1 moves along x")) << r.all();
  EXPECT_TRUE(r.says(":19:", "must be >= 0 N")) << r.all();
  EXPECT_TRUE(r.says(":14:", "v0_mps: is missing")) << r.all();
  EXPECT_TRUE(r.says(":23:", "another channel")) << r.all();
  EXPECT_TRUE(r.says(":27:", "neighboring floors")) << r.all();
  EXPECT_TRUE(r.says(":32:", "expected a number")) << r.all();
  EXPECT_TRUE(r.says(":30:", "direction: is missing")) << r.all();
  EXPECT_TRUE(r.says(":35:", "floor = \"rigid\"")) << r.all();
}

TEST(Effects, AnUnstableBuildingIsRefused) {
  const Reading r = read(
      "[[effect]]\nkind = \"p_delta\"\nstory = 1\nframe = \"y1\"\n"
      "weight_n = 1e6\n");
  EXPECT_FALSE(r.scenario);
  EXPECT_TRUE(r.says(":5:", "cannot stand")) << r.all();
}

TEST(Effects, ATableInsteadOfAListIsRefused) {
  EXPECT_TRUE(read("[effect]\nkind = \"polarity\"\n").says(":5:", "write [[effect]]"));
}

TEST(Effects, ADivergingSofteningFrameIsNoticed) {
  const Reading r = read(
      "[[effect]]\nkind = \"cubic_stiffness\"\nstory = 1\nframe = \"y1\"\n"
      "k3_npm3 = -1e13\n");
  ASSERT_TRUE(r.scenario) << r.all();
  Simulation simulation(*r.scenario);
  bool collapsed = false;
  for (std::int64_t i = 0; i < instants(*r.scenario) && !collapsed; ++i) {
    simulation.next();
    collapsed = simulation.collapsed();
  }
  EXPECT_TRUE(collapsed);
}

TEST(Effects, ALateChannelIsLateByItsShift) {
  const Reading on_time = read(""), late = read(
                                        "[[effect]]\nkind = \"time_shift\"\n"
                                        "channel = \"F2-Y1\"\nshift_s = 0.02\n");
  ASSERT_TRUE(on_time.scenario && late.scenario) << late.all();
  Simulation a(*on_time.scenario), b(*late.scenario);
  std::vector<double> before;
  for (int i = 0; i < 200; ++i) {
    before.push_back(a.next()[6]);
    const double shifted = b.next()[6];
    if (i >= 2) {
      EXPECT_NEAR(shifted, before[before.size() - 3], 1e-6);
    }
  }
}

TEST(Effects, TruthNamesTheHiddenEffects) {
  const Reading r = read(
      "[[effect]]\nkind = \"polarity\"\nchannel = \"base-x\"\n"
      "[[effect]]\nkind = \"extra_mass\"\nstory = 2\nnode = \"x2y1\"\n"
      "mass_kg = 2\n");
  ASSERT_TRUE(r.scenario) << r.all();
  const std::string truth = truth_json(*r.scenario);
  EXPECT_NE(truth.find("\"effect\": \"polarity\""), std::string::npos);
  EXPECT_NE(truth.find("\"kind\": \"base\""), std::string::npos);
  EXPECT_NE(truth.find("\"node\": \"x2y1\""), std::string::npos);
  const Reading none = read("");
  ASSERT_TRUE(none.scenario);
  EXPECT_NE(truth_json(*none.scenario).find("\"effect\": \"none\""), std::string::npos);
}

TEST(Effects, ExampleScenariosAreGood) {
  for (const char* name : {"cubic_first_story", "hidden_bouc_wen", "loose_sensor"}) {
    std::vector<ConfigProblem> problems;
    EXPECT_TRUE(load_scenario(
        std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/scenario_" + name + ".toml", problems))
        << name;
  }
}

}  // namespace effects_test
}  // namespace framewatch::daemon
