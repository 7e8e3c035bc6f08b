// SPDX-License-Identifier: MIT
#include "daemon/tools/init/building_toml.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/tools/init/dialogue.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace building_toml_test {

InitReading read(std::map<std::string, std::string, std::less<>> answers) {
  ColumnCache files;
  return read_answers({std::move(answers), {}, {}}, true, files);
}

std::string open(const InitReading& reading) {
  std::string out;
  for (const OpenQuestion& q : reading.open) out += q.option + ": " + q.problem + "\n";
  return out;
}

/// Returns the configuration made of these answers.
Config config_of(const std::map<std::string, std::string, std::less<>>& answers) {
  const InitReading reading = read(answers);
  EXPECT_EQ(open(reading), "");
  if (!reading.open.empty()) return {};
  return test::good(building_toml(reading.draft.plan));
}

double lowest_hz(const Config& config) {
  const estimator::Structure& s = config.pipeline.structure;
  return lowest_frequency_hz(s, estimator::ParameterTable(s), config.pipeline.design);
}

TEST(BuildingToml, EveryShapeIsValidAndPlausible) {
  for (const char* live : {"lcm", "none"})
    for (const char* floors : {"flexible", "rigid"})
      for (const int stories : {1, 2, 3, 5, 9, 20})
        for (const char* bays : {"0x0", "1x1", "2x1", "1x3", "5x3", "0x2"}) {
          std::map<std::string, std::string, std::less<>> answers{
              {"live", live},
              {"stories", std::to_string(stories)},
              {"bays", bays},
              {"heights", "3"},
              {"mass", "500kg/m2"}};
          if (bays[0] != '0') answers["span-x"] = "6";
          if (bays[2] != '0') answers["span-y"] = "5";
          if (bays[0] == '0' || bays[2] == '0') answers["area"] = "60";
          if (std::string(bays) != "0x0") answers["floors"] = floors;
          const Config config = config_of(answers);
          EXPECT_EQ(test::told(config.doubts), "") << stories << " stories, " << bays;
          EXPECT_NEAR(lowest_hz(config), 46.0 / (3 * stories), 1e-4)
              << stories << " stories, " << bays;
        }
}

TEST(BuildingToml, HandlesASingleDirection) {
  for (const char* direction : {"x", "y"}) {
    const Config one = config_of({{"live", "lcm"},
                                  {"directions", direction},
                                  {"stories", "3"},
                                  {"heights", "4, 3, 3"},
                                  {"mass", "12 t"}});
    EXPECT_EQ(one.pipeline.structure.frames(), 1);
    EXPECT_EQ(one.pipeline.axes.size(), 4u);
    EXPECT_EQ(one.pipeline.structure.node_mass, std::vector<double>(3, 12000.0));
    EXPECT_NEAR(lowest_hz(one), 4.6, 1e-3);
  }
  const Config two = config_of({{"live", "lcm"},
                                {"directions", "x"},
                                {"bays", "0x2"},
                                {"span-y", "4, 6"},
                                {"stories", "2"},
                                {"heights", "3"},
                                {"mass", "10000"}});
  EXPECT_EQ(two.pipeline.structure.node_mass,
            (std::vector<double>{2000, 5000, 3000, 2000, 5000, 3000}));
}

TEST(BuildingToml, MassesAndStiffnessesMatchTheAnswers) {
  const std::map<std::string, std::string, std::less<>> house{
      {"live", "none"},           {"stories", "2"},    {"bays", "2x1"},
      {"span-x", "6, 4"},         {"span-y", "5"},     {"heights", "3.5, 3"},
      {"mass", "300, 200 kg/m2"}, {"start", "6, 8 Hz"}};
  const Config config = config_of(house);
  const estimator::Structure& s = config.pipeline.structure;
  EXPECT_EQ(s.node_mass, (std::vector<double>{2250, 3750, 1500, 2250, 3750, 1500,  //
                                              1500, 2500, 1000, 1500, 2500, 1000}));
  EXPECT_EQ(s.story_height, (std::vector<double>{3.5, 3}));
  EXPECT_NEAR(lowest_hz(config), 6, 1e-4);
  auto stiff = house;
  stiff["start"] = "30, 20 MN/m";
  const Config given = config_of(stiff);
  const estimator::ParameterTable table(s);
  EXPECT_DOUBLE_EQ(given.pipeline.design[table.frame_stiffness(1, 0)], 15e6);
  EXPECT_DOUBLE_EQ(given.pipeline.design[table.frame_stiffness(2, 3)], 10e6);
  auto period = house;
  period["start"] = "0.2 s";
  EXPECT_NEAR(lowest_hz(config_of(period)), 5, 1e-4);
  auto none = house;
  none["start"] = "none";
  EXPECT_EQ(config_of(none).pipeline.design.size(), 0);
}

TEST(BuildingToml, AModelStartsFromTheData) {
  const Config config = config_of({{"live", "none"},
                                   {"stories", "3"},
                                   {"bays", "0x0"},
                                   {"heights", "0.3"},
                                   {"mass", "5"},
                                   {"rate", "250 Hz"}});
  EXPECT_EQ(config.pipeline.design.size(), 0);
  EXPECT_EQ(config.pipeline.options.rate_hz, 250);
  EXPECT_EQ(test::told(config.doubts), "");
}

TEST(BuildingToml, LcmNodesAreNumberedAsTheChannels) {
  std::map<std::string, std::string, std::less<>> answers{
      {"live", "lcm"}, {"stories", "1"}, {"bays", "0x0"}, {"heights", "3"}, {"mass", "1000"}};
  const Config one = config_of(answers);  // one node per floor
  EXPECT_EQ(one.sources[0].sensor_node, 0);
  EXPECT_EQ(one.sources[1].sensor_node, 0);
  EXPECT_EQ(one.sources[3].sensor_node, 1);
  EXPECT_EQ(one.sources[3].axis, 1);
  answers.insert({{"bays", "1x1"}, {"span-x", "3"}, {"span-y", "3"}});
  answers["bays"] = "1x1";
  const Config each = config_of(answers);
  for (std::size_t i = 0; i < each.sources.size(); ++i)
    EXPECT_EQ(each.sources[i].sensor_node, static_cast<int>(i));
}

TEST(BuildingToml, ReportsMissingAndWrongAnswersAtOnce) {
  EXPECT_EQ(open(read({})), "live: \nstories: \nbays: \nspan-x: \nspan-y: \nheights: \nmass: \n");
  const InitReading wrong = read({{"live", "lcm"},
                                  {"stories", "2"},
                                  {"bays", "1"},
                                  {"span-x", "6"},
                                  {"span-y", "-5"},
                                  {"heights", "3,3,3"},
                                  {"mass", "18 lb"},
                                  {"start", "1.8"},
                                  {"area", "7"}});
  const std::string told = open(wrong);
  for (const char* part :
       {"bays: write the bays along x, an x and the bays along y", "span-y: lengths in m",
        "heights: there are 3 numbers: give one for all, or 2", "mass: unknown unit lb",
        "start: a frequency (1.8 Hz;", "area: does not fit the other answers"})
    EXPECT_NE(told.find(part), std::string::npos) << part << "\n" << told;
}

}  // namespace building_toml_test
}  // namespace framewatch::daemon
