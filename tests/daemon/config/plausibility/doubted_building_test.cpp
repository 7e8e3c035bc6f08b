// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/simulation/scenario.h"
#include "tests/support/config_fixture.h"
#include "tests/support/data.h"
#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace doubted_building_test {

/// Two stories of 3.5 m, 6 m x 4 m, 300 kg/m^2, near the frequency of 46 / height.
constexpr const char* kHouse = R"([structure]
stories = 2
frames_x = ["y1", "y2"]
frames_y = ["x1", "x2"]
span_x_m = [6.0]
span_y_m = [4.0]
story_height_m = [3.5, 3.5]
node_mass_kg = 1800.0

[structure.design]
kx_npm = [[12e6, 10e6], [11e6, 11e6]]
ky_npm = [[12e6, 10e6], [11e6, 11e6]]
damping_ratio = 0.02

[[channel]]
name = "bx"
story = 0
direction = "x"
[[channel]]
name = "by"
story = 0
direction = "y"
[[channel]]
name = "1y1"
story = 1
frame = "y1"
[[channel]]
name = "1y2"
story = 1
frame = "y2"
[[channel]]
name = "1x1"
story = 1
frame = "x1"
[[channel]]
name = "1x2"
story = 1
frame = "x2"
[[channel]]
name = "2y1"
story = 2
frame = "y1"
[[channel]]
name = "2y2"
story = 2
frame = "y2"
[[channel]]
name = "2x1"
story = 2
frame = "x1"
[[channel]]
name = "2x2"
story = 2
frame = "x2"
)";

std::string with(const std::string& what, const std::string& by) {
  return test::replaced(kHouse, what, by);
}

std::string doubts_of(const std::string& text) {
  return test::told(test::good(text).doubts);
}

/// Expects exactly one doubt with these parts.
void expect_doubt(const std::string& text, const std::vector<std::string>& parts) {
  const std::vector<ConfigProblem> doubts = test::good(text).doubts;
  ASSERT_EQ(doubts.size(), 1u) << test::told(doubts);
  for (const std::string& part : parts)
    EXPECT_NE((doubts[0].where + ": " + doubts[0].message).find(part), std::string::npos)
        << part << " in\n"
        << test::told(doubts);
}

/// A model on a table: two stories of 30 cm, 20 kg a floor.
std::string model(const std::string& kx) {
  std::string text = with("span_x_m = [6.0]", "span_x_m = [0.5]");
  text = test::replaced(text, "span_y_m = [4.0]", "span_y_m = [0.4]");
  text = test::replaced(text, "[3.5, 3.5]", "0.3");
  text = test::replaced(text, "1800.0", "5.0");
  text = test::replaced(text, "kx_npm = [[12e6, 10e6], [11e6, 11e6]]", "kx_npm = " + kx);
  return test::replaced(text, "ky_npm = [[12e6, 10e6], [11e6, 11e6]]", "ky_npm = " + kx);
}

TEST(DoubtedBuilding, AcceptsAnOrdinaryHouseAndAModel) {
  EXPECT_EQ(doubts_of(kHouse), "");
  EXPECT_EQ(doubts_of(model("[[11e3, 9e3], [8e3, 9e3]]")), "");
}

TEST(DoubtedBuilding, StoriesOf400Metres) {
  const std::string text = with("[3.5, 3.5]", "[3.5, 400]");
  const std::string told = doubts_of(text);
  EXPECT_TRUE(told.starts_with("c.toml:7:24: structure.story_height_m: 400 m; stories")) << told;
  EXPECT_NE(told.find("in cm where m is asked? Then it is 4"), std::string::npos) << told;
  EXPECT_NE(doubts_of(with("[3.5, 3.5]", "350")).find(":7:18: "), std::string::npos);
}

TEST(DoubtedBuilding, StiffnessInKilonewtons) {
  std::string text = with("kx_npm = [[12e6, 10e6], [11e6, 11e6]]", "kx_npm = 11e3");
  text = test::replaced(text, "ky_npm = [[12e6, 10e6], [11e6, 11e6]]", "ky_npm = 11e3");
  expect_doubt(
      text, {"c.toml:11:10: ", "first natural frequency is ", "buildings of 7 m have about 6.6 Hz",
             "stiffness in kN/m where N/m is asked?"});
  text = test::replaced(text, "kx_npm = 11e3", "kx_npm = 11");
  text = test::replaced(text, "ky_npm = 11e3", "ky_npm = 11");
  expect_doubt(text, {"stiffness in MN/m where N/m is asked?"});
}

TEST(DoubtedBuilding, StiffnessOfAModelInKilonewtons) {
  expect_doubt(model("[[1.1, 0.9], [0.8, 0.9]]"),
               {"models have 0.2 to 100 Hz", "stiffness in kN/m where N/m is asked?"});
}

TEST(DoubtedBuilding, MassesInTonnes) {
  const std::string told = doubts_of(with("1800.0", "1.8"));
  EXPECT_NE(
      told.find("c.toml:8:16: structure.node_mass_kg: 7.2 kg on the 24 m^2 of floor 1 are 0.3 "
                "kg/m^2; floors of buildings have 20 to 3000: mass in tonnes where kg is asked?"),
      std::string::npos)
      << told;
  EXPECT_NE(told.find("structure.design: with"), std::string::npos) << told;
}

TEST(DoubtedBuilding, AWholeFloorsMassAtEachNode) {
  std::string text = with("1800.0", "[[[1800, 1800], [1800, 1800]], [[2e4, 2e4], [2e4, 2e4]]]");
  expect_doubt(text, {"c.toml:8:49: ", "of floor 2 are 3.33e+03 kg/m^2",
                      "the whole floor's mass given to each of its nodes?"});
}

TEST(DoubtedBuilding, SpansInMillimetres) {
  const std::string told = doubts_of(with("[4.0]", "[400.0]"));
  EXPECT_NE(
      told.find("c.toml:6:13: structure.span_y_m: 400 m; spans are 0.05 to 100 m: in cm where "
                "m is asked? Then it is 4"),
      std::string::npos)
      << told;
}

TEST(DoubtedBuilding, DampingOfTheFirstMode) {
  expect_doubt(with("damping_ratio = 0.02", "damping_ratio = 0.5"),
               {"c.toml:13:17: ", "damping ratio is 0.5; buildings have 0.001 to 0.3"});
  expect_doubt(with("damping_ratio = 0.02", "damping_ratio = 0.0002"), {"0.02 stands for 2 %"});
  // Dampings of single elements count, not the ratio that they replace.
  expect_doubt(with("damping_ratio = 0.02", "cx_nspm = 9e5\ncy_nspm = 9e5"),
               {"c.toml:13:11: ", "in another unit than N*s/m?"});
}

TEST(DoubtedBuilding, OneStoryAThousandTimesAsStiffAsAnother) {
  expect_doubt(
      with("kx_npm = [[12e6, 10e6], [11e6, 11e6]]", "kx_npm = [[12e6, 10e6], [11e9, 11e9]]"),
      {"structure.design.kx_npm: story 2 has 2.2e+10 N/m in all, story 1 2.2e+07 N/m",
       "100 times"});
}

TEST(DoubtedBuilding, AcceptsShippedConfigurations) {
  int seen = 0;
  for (const char* folder : {"/configs", "/configs/can"})
    for (const auto& entry :
         std::filesystem::directory_iterator(FRAMEWATCH_SOURCE_DIR + std::string(folder))) {
      const std::string path = entry.path().string();
      if (!path.ends_with(".toml") || path.ends_with("/vehicle.toml"))
        continue;  // its DBC is missing
      std::vector<ConfigProblem> problems;
      if (entry.path().filename().string().starts_with("scenario_")) {
        const auto scenario = load_scenario(path, problems);
        ASSERT_TRUE(scenario) << path << "\n" << test::told(problems);
        EXPECT_EQ(test::told(scenario->config.doubts), "");
      } else {
        const auto config = load_config(path, problems);
        ASSERT_TRUE(config) << path << "\n" << test::told(problems);
        EXPECT_EQ(test::told(config->doubts), "");
      }
      ++seen;
    }
  EXPECT_GE(seen, 17);
}

TEST(DoubtedBuilding, CheckRunAndReplayWarnAndContinue) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("house.toml"), with("[3.5, 3.5]", "400"));
  const std::string doubt = "house.toml:7:18: structure.story_height_m: 400 m";
  const auto check = test::shell(directory, "$F check house.toml");
  EXPECT_EQ(check.status, 0);
  EXPECT_NE(check.out.find("warning: " + doubt), std::string::npos) << check.out;
  EXPECT_NE(test::shell(directory, "$F check --json house.toml").out.find(doubt),
            std::string::npos);
  const auto replay = test::shell(
      directory, "printf 'time_s,bx\\n0,1\\n0.01,2\\n' >r.csv && $F replay house.toml r.csv");
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.err.find(doubt), std::string::npos) << replay.err;
  const auto run = test::shell(directory, "timeout -s TERM 2 $F run house.toml --by-name --quiet");
  EXPECT_NE(run.err.find(doubt), std::string::npos) << run.err;
}

}  // namespace doubted_building_test
}  // namespace framewatch::daemon
