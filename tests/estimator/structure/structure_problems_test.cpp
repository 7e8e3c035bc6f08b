// SPDX-License-Identifier: MIT
#include "estimator/structure/structure.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace structure_problems_test {

/// Returns the fields of the problems that a change causes in a valid building.
std::vector<std::string> fields_after(const std::function<void(Structure&)>& change) {
  Structure s = test::table2();
  change(s);
  std::vector<std::string> fields;
  for (const Problem& p : find_problems(s)) {
    EXPECT_EQ(p.index, -1);
    EXPECT_FALSE(p.message.empty());
    fields.push_back(p.field);
  }
  return fields;
}

using Fields = std::vector<std::string>;

TEST(StructureProblems, SoundBuildingsHaveNone) {
  EXPECT_TRUE(find_problems(test::table1()).empty());
  EXPECT_TRUE(find_problems(test::table2()).empty());
}

TEST(StructureProblems, EveryMalformedTwinIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fields_after([](Structure& s) { s.span_x.pop_back(); }), Fields{"span_x_m"});
  EXPECT_EQ(fields_after([](Structure& s) { s.span_x[1] = 0; }), Fields{"span_x_m"});
  EXPECT_EQ(fields_after([](Structure& s) { s.span_y.push_back(1); }), Fields{"span_y_m"});
  EXPECT_EQ(fields_after([](Structure& s) { s.span_y[0] = -3; }), Fields{"span_y_m"});
  EXPECT_EQ(fields_after([](Structure& s) { s.story_height.clear(); }), Fields{"story_height_m"});
  EXPECT_EQ(fields_after([&](Structure& s) { s.story_height[0] = nan; }), Fields{"story_height_m"});
  EXPECT_EQ(fields_after([](Structure& s) { s.node_mass.pop_back(); }), Fields{"node_mass_kg"});
  EXPECT_EQ(fields_after([&](Structure& s) { s.node_mass[5] = infinity; }), Fields{"node_mass_kg"});
  EXPECT_EQ(fields_after([](Structure& s) { s.node_mass[0] = 0; }), Fields{"node_mass_kg"});
  EXPECT_EQ(fields_after([](Structure& s) { s.frames_x[1].clear(); }), Fields{"frames_x"});
  EXPECT_EQ(fields_after([](Structure& s) { s.frames_x[1] = "y1"; }), Fields{"frames_x"});
  EXPECT_EQ(fields_after([](Structure& s) { s.frames_y[0] = "y1"; }), Fields{"frames_y"});
}

TEST(StructureProblems, AreReportedAllAtOnce) {
  EXPECT_EQ(fields_after([](Structure& s) {
              s.span_x.clear();
              s.node_mass[0] = -1;
              s.frames_y[3] = "";
            }),
            (Fields{"span_x_m", "node_mass_kg", "frames_y"}));
}

TEST(StructureProblems, RefuseAnEmptyBuilding) {
  const std::vector<Problem> found = find_problems(Structure{});
  bool stories = false, frames = false;
  for (const Problem& p : found) {
    stories = stories || p.field == "stories";
    frames = frames || (p.field.empty() && p.message.find("frame") != std::string::npos);
  }
  EXPECT_TRUE(stories);
  EXPECT_TRUE(frames);
}

TEST(StructureProblems, NegativeStoriesAreNamedAndHarmless) {
  const Fields fields = fields_after([](Structure& s) { s.stories = -2; });
  ASSERT_FALSE(fields.empty());
  EXPECT_EQ(fields.front(), "stories");
}

TEST(StructureProblems, EveryFrameOrNoneHasALabelOfItsOwn) {
  const auto labelled = [](const std::vector<std::string>& labels) {
    return fields_after([&](Structure& s) { s.labels_x = labels; });
  };
  EXPECT_EQ(labelled({"a", "b", "c", "d"}), Fields{});
  EXPECT_EQ(labelled({"a", "b"}), Fields{"labels_x"});
  EXPECT_EQ(labelled({"a", "b", "c", "a"}), Fields{"labels_x"});
  EXPECT_EQ(labelled({"a", "b", "c", "x1"}), Fields{"labels_x"}) << "a frame's name";
}

TEST(StructureProblems, NameFieldAndRule) {
  Structure s = test::table1();
  s.span_x = {1, 2, 3};
  ASSERT_EQ(problems(s).size(), 1u);
  EXPECT_EQ(problems(s).front(), "span_x_m: expected 1 values, found 3");
}

}  // namespace structure_problems_test
}  // namespace framewatch::estimator
