// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/page/view/page_json.h"
#include "daemon/tools/demo/demo_scenario.h"

namespace framewatch::daemon {
namespace page_json_test {

nlohmann::json building_of(const Scenario& scenario) {
  return nlohmann::json::parse(building_json(scenario.config, 100));
}

TEST(BuildingJson, NamesTheStoriesOfGroups) {
  const auto building = building_of(tall_demo_scenario());
  EXPECT_EQ(building["grouped"], true);
  ASSERT_EQ(building["parameters"].size(), 32u);  // 4 groups of 4 frames, stiffness and damping
  const auto& first = building["parameters"][0];
  EXPECT_EQ(first["name"], "kx_1to5_y1");
  EXPECT_EQ(first["story"], 1);
  EXPECT_EQ(first["last_story"], 5);
  EXPECT_EQ(first["frames"], nlohmann::json({0}));
  EXPECT_EQ(first["direction"], "x");
  // of five springs in series, 1196e6 to 1032e6 N/m
  EXPECT_NEAR(first["design"].get<double>(), 1111e6 / 5, 3e6);
}

TEST(BuildingJson, HasNoGroupsIfEveryStoryIsMeasured) {
  const auto building = building_of(demo_scenario());
  EXPECT_EQ(building["grouped"], false);
  for (const auto& p : building["parameters"]) EXPECT_FALSE(p.contains("last_story"));
}

TEST(BuildingJson, HasTheLabelsOfFrames) {
  Scenario scenario = demo_scenario();
  EXPECT_EQ(building_of(scenario)["labels"], nlohmann::json::object());
  scenario.config.pipeline.structure.labels_x = {"south wall", "north wall"};
  EXPECT_EQ(building_of(scenario)["labels"]["y2"], "north wall");
}

TEST(BuildingJson, PlacesChannelsThatRideOnNoFrame) {
  Scenario scenario = tall_demo_scenario();
  scenario.config.pipeline.axes[0].plan = estimator::PlanPlace{3, 4, 0};
  const auto building = building_of(scenario);
  EXPECT_EQ(building["axes"][0]["x_m"], 3);
  EXPECT_EQ(building["axes"][0]["y_m"], 4);
  EXPECT_FALSE(building["axes"][1].contains("x_m"));
}

}  // namespace page_json_test
}  // namespace framewatch::daemon
