// SPDX-License-Identifier: MIT
#include "estimator/structure/sensors.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace sensor_problems_test {

using Axes = std::vector<SensorAxis>;
constexpr std::size_t kBaseX = 20;  ///< number of axes of table1
constexpr std::size_t kBaseY = 21;

std::vector<Problem> problems_after(const std::function<void(Axes&)>& change) {
  Axes axes = test::full_sensor_axes(test::table1());
  change(axes);
  return find_problems(test::table1(), axes);
}

void expect_one(const std::function<void(Axes&)>& change, const std::string& field, int index,
                const std::string& part) {
  const std::vector<Problem> found = problems_after(change);
  ASSERT_EQ(found.size(), 1u) << part;
  EXPECT_EQ(found[0].field, field);
  EXPECT_EQ(found[0].index, index);
  EXPECT_NE(found[0].message.find(part), std::string::npos) << found[0].message;
}

TEST(SensorProblems, CompleteArraysHaveNone) {
  EXPECT_TRUE(problems_after([](Axes&) {}).empty());
}

TEST(SensorProblems, EveryMalformedAxisIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_one([](Axes& a) { a[3].name = ""; }, "name", 3, "needs a name");
  expect_one([](Axes& a) { a[4].name = a[1].name; }, "name", 4, "has this name already");
  expect_one([](Axes& a) { a[0].scale = 0; }, "scale", 0, "scale");
  expect_one([&](Axes& a) { a[0].scale = nan; }, "scale", 0, "scale");
  expect_one([](Axes& a) { a[7].polarity = 0.5; }, "polarity", 7, "polarity");
}

TEST(SensorProblems, InvalidNumbersAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_one([&](Axes& a) { a[2].offset = nan; }, "offset", 2, "offset");
  expect_one([&](Axes& a) { a[2].delay = nan; }, "delay_s", 2, "delay");
  expect_one([&](Axes& a) { a[2].noise_density = -1e-4; }, "noise_mps2_per_rthz", 2, "noise");
}

TEST(SensorProblems, MissingPlacesAreNamed) {
  for (const int story : {-1, 6})
    expect_one([&](Axes& a) { a[0].story = story; }, "story", 0, "does not exist");
  for (const int frame : {-1, 4})
    expect_one([&](Axes& a) { a[5].frame = frame; }, "frame", 5, "does not exist");
}

TEST(SensorProblems, TwoAxesClaimingOnePlaceAreNamed) {
  const auto found = problems_after([](Axes& a) {
    SensorAxis twin = a[2];
    twin.name = "twin";
    a.push_back(twin);
  });
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].index, 22);
  EXPECT_NE(found[0].message.find("'F1-x1'"), std::string::npos);
}

TEST(SensorProblems, MissingBaseChannelsAreNamed) {
  expect_one([](Axes& a) { a.erase(a.begin() + kBaseX); }, "", -1, "direction x");
  expect_one([](Axes& a) { a.erase(a.begin() + kBaseY); }, "", -1, "direction y");
  expect_one([](Axes& a) { a.clear(); }, "", -1, "above the base");
  EXPECT_TRUE(problems_after([](Axes& a) { a.erase(a.begin() + 7); }).empty());
}

TEST(SensorProblems, AxesAtAPlaceNeedFramesInTheirDirection) {
  Structure s = test::table1();
  Axes axes = test::full_sensor_axes(s);
  axes[0].frame = -1;
  axes[0].plan = PlanPlace{5, 5, 0};
  EXPECT_TRUE(find_problems(s, axes).empty());
  axes.push_back(axes[0]);  // two axes at one place are averaged
  axes.back().name = "twin";
  EXPECT_TRUE(find_problems(s, axes).empty());
}

TEST(SensorProblems, BaseAxesMayRideOnFrames) {
  EXPECT_TRUE(problems_after([](Axes& a) {
                a[kBaseX].frame = 0;
                a[kBaseY].frame = 3;
              }).empty());
}

TEST(SensorProblems, PlaneBuildingNeedsOneDirectionOnly) {
  Structure s;
  s.stories = 1;
  s.frames_y = {"x1"};
  s.story_height = {3};
  s.node_mass = {100};
  const Axes axes = test::full_sensor_axes(s);
  ASSERT_EQ(axes.size(), 2u);
  EXPECT_TRUE(find_problems(s, axes).empty());
}

}  // namespace sensor_problems_test
}  // namespace framewatch::estimator
