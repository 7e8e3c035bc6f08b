// SPDX-License-Identifier: MIT
// Tests [fragility]: HAZUS' limits, custom medians, and every mistake.
#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "daemon/config/keys/option_table.h"
#include "daemon/config/sections/fragility.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace sections_fragility_test {

std::string building(int stories) {
  return "[structure]\nstories = " + std::to_string(stories) +
         "\nframes_x = [\"y1\"]\nstory_height_m = 3\nnode_mass_kg = 1000\n"
         "[structure.design]\nkx_npm = 1e6\ndamping_ratio = 0.02\n"
         "[[channel]]\nname = \"base\"\nstory = 0\ndirection = \"x\"\n"
         "[[channel]]\nname = \"roof\"\nframe = \"y1\"\nstory = " +
         std::to_string(stories) + "\n";
}

Config good(const std::string& section, int stories = 3) {
  std::vector<ConfigProblem> problems;
  const auto config = parse_config("b.toml", building(stories) + section, problems);
  EXPECT_TRUE(config) << (problems.empty() ? "" : problems.front().message);
  return config ? *config : Config{};
}

std::vector<ConfigProblem> wrong(const std::string& section, int stories = 3) {
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(parse_config("b.toml", building(stories) + section, problems)) << section;
  return problems;
}

TEST(Fragility, IsOptionalAndAssumesNoType) {
  EXPECT_FALSE(good("").fragility);
}

TEST(Fragility, GivesATypeTheLimitsOfASingleStory) {
  const Config c = good("[fragility]\ntype = \"C1\"\ndesign_level = \"high\"\n", 8);
  ASSERT_EQ(c.fragility->by_story.size(), 8u);
  for (const estimator::Fragility& f : c.fragility->by_story) {
    EXPECT_EQ(f.median, (std::array{0.005, 0.01, 0.03, 0.08}));
    EXPECT_EQ(f.dispersion, (std::array{0.4, 0.4, 0.4, 0.4}));
  }
  EXPECT_EQ(c.fragility->source, "HAZUS C1L, high code");
  EXPECT_EQ(c.fragility->rules.restricted, 0.25);
}

TEST(Fragility, DependsOnTheNumberOfStoriesOnRequest) {
  const auto first = [](const std::string& type, int stories) {
    return good("[fragility]\ntype = \"" + type +
                    "\"\ndesign_level = \"low\"\ndrift_limits = \"height\"\n",
                stories)
        .fragility->source;
  };
  EXPECT_EQ(first("C1", 3), "HAZUS C1L, low code");
  EXPECT_EQ(first("C1", 4), "HAZUS C1M, low code");
  EXPECT_EQ(first("C1", 8), "HAZUS C1H, low code");
  EXPECT_EQ(first("URM", 3), "HAZUS URMM, low code");
  EXPECT_EQ(first("RM1", 9), "HAZUS RM1M, low code");
  EXPECT_EQ(first("W1", 9), "HAZUS W1, low code");
  EXPECT_EQ(first("S1L", 9), "HAZUS S1L, low code");
}

TEST(Fragility, EveryTypeHasAscendingLimits) {
  for (const std::string& type : choices(*find_option("fragility", "type")))
    for (const int stories : {1, 5, 12}) {
      const auto low = hazus_limits(hazus_type_by_height(type, stories), DesignLevel::low);
      ASSERT_TRUE(low) << type;
      EXPECT_TRUE(std::is_sorted(low->begin(), low->end())) << type;
      const auto pre = hazus_limits(hazus_type_of_story(type), DesignLevel::pre);
      ASSERT_TRUE(pre) << type;
      EXPECT_LT((*pre)[3], 0.0601) << type;
    }
}

TEST(Fragility, AcceptsOwnMediansByStoryOrForAll) {
  const Config c = good(
      "[fragility]\nslight_drift_ratio = 0.004\nmoderate_drift_ratio = [0.007, 0.008, 0.009]\n"
      "extensive_drift_ratio = 0.02\ncomplete_drift_ratio = 0.05\nmoderate_dispersion = 0.3\n"
      "unsafe_probability = 0.1\n");
  EXPECT_EQ(c.fragility->by_story[2].median, (std::array{0.004, 0.009, 0.02, 0.05}));
  EXPECT_EQ(c.fragility->by_story[2].dispersion, (std::array{0.4, 0.3, 0.4, 0.4}));
  EXPECT_EQ(c.fragility->rules.unsafe, 0.1);
  EXPECT_EQ(c.fragility->source, "medians of [fragility]");
  const Config mixed =
      good("[fragility]\ntype = \"C1\"\ndesign_level = \"high\"\ncomplete_drift_ratio = 0.06\n");
  EXPECT_EQ(mixed.fragility->by_story[0].median[3], 0.06);
  EXPECT_EQ(mixed.fragility->source, "HAZUS C1L, high code, with medians of [fragility]");
}

TEST(Fragility, ReportsAllProblemsWithTheirLines) {
  const auto problems = wrong(
      "[fragility]\ntype = \"C9\"\nrestricted_probability = 2\nmoderate_drift_ratio = -1\n"
      "slight_dispersion = \"wide\"\nlimits = 3\n");
  ASSERT_EQ(problems.size(), 5u);
  for (const ConfigProblem& p : problems) EXPECT_NE(p.where.find("b.toml:"), std::string::npos);
  EXPECT_NE(problems[0].message.find("fragility.type: must be one of"), std::string::npos);
}

TEST(Fragility, RefusesContradictingKeys) {
  const std::pair<const char*, const char*> kCases[] = {
      {"[fragility]\n", "must be given if there is no type"},
      {"[fragility]\ntype = \"C1\"\n", "design_level: must be given with type"},
      {"[fragility]\ntype = \"URM\"\ndesign_level = \"high\"\n",
       "HAZUS has no drift limits of URML"},
      {"[fragility]\ntype = \"C1\"\ndesign_level = \"high\"\nmoderate_drift_ratio = 0.004\n",
       "must be below slight_drift_ratio < moderate_drift_ratio"},
      {"[fragility]\ntype = \"C1\"\ndesign_level = \"high\"\nmoderate_drift_ratio = [0.01, 0.01]\n",
       "moderate_drift_ratio"},
      {"[fragility]\nslight_drift_ratio = 0.01\nmoderate_drift_ratio = 0.02\n"
       "extensive_drift_ratio = 0.03\ncomplete_drift_ratio = 0.04\ndesign_level = \"low\"\n",
       "has no effect without a type"}};
  for (const auto& [section, message] : kCases) {
    const auto problems = wrong(section);
    ASSERT_FALSE(problems.empty()) << section;
    EXPECT_TRUE(std::any_of(
        problems.begin(), problems.end(),
        [&](const ConfigProblem& p) { return p.message.find(message) != std::string::npos; }))
        << section << problems.front().message;
  }
}

}  // namespace sections_fragility_test
}  // namespace framewatch::daemon
