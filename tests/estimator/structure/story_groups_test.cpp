// SPDX-License-Identifier: MIT
#include "estimator/structure/story_groups.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {
namespace story_groups_test {

Structure building(FloorModel floor, int stories = 6) {
  Structure s;
  s.stories = stories;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2"};
  s.span_x = {12};
  s.span_y = {8};
  s.story_height.assign(static_cast<std::size_t>(stories), 3);
  s.node_mass.assign(static_cast<std::size_t>(4 * stories), 1e4);
  s.floor = floor;
  return s;
}

SensorAxis on(int story, int frame, const Structure& s) {
  SensorAxis a;
  a.story = story;
  a.frame = frame;
  a.direction = s.direction(frame);
  return a;
}

SensorAxis at(int story, double x_m, double y_m, double angle_rad) {
  SensorAxis a;
  a.story = story;
  a.plan = PlanPlace{x_m, y_m, angle_rad};
  a.direction = std::abs(std::cos(angle_rad)) > 0.7 ? Direction::x : Direction::y;
  return a;
}

std::vector<std::string> names(const Structure& s, const std::vector<SensorAxis>& axes) {
  const ParameterTable table(s, story_groups(s, axes), {});
  std::vector<std::string> out;
  for (int p = 0; p < table.elements(); ++p) out.push_back(table[p].name);
  return out;
}

using Names = std::vector<std::string>;

TEST(StoryGroups, AreSingleStoriesIfEveryFloorIsMeasured) {
  const Structure s = building(FloorModel::flexible, 2);
  std::vector<SensorAxis> axes;
  for (int story = 1; story <= 2; ++story)
    for (int f = 0; f < 4; ++f) axes.push_back(on(story, f, s));
  EXPECT_TRUE(story_groups(s, axes).every_story);
  axes.pop_back();
  EXPECT_FALSE(story_groups(s, axes).every_story);
}

TEST(StoryGroups, ThreeAxesOnRigidFloorsDistinguishTwoFrames) {
  const Structure s = building(FloorModel::rigid);
  std::vector<SensorAxis> axes;
  for (const int story : {3, 6})
    for (const int f : {0, 1, 2}) axes.push_back(on(story, f, s));
  EXPECT_EQ(names(s, axes), (Names{"kx_1to3_y1", "kx_4to6_y1", "kx_1to3_y2", "kx_4to6_y2",
                                   "ky_1to3_x1", "ky_4to6_x1", "ky_1to3_x2", "ky_4to6_x2"}));
}

TEST(StoryGroups, TwoAxesOnRigidFloorsShowOnlyDirections) {
  const Structure s = building(FloorModel::rigid);
  std::vector<SensorAxis> axes;
  for (const int story : {1, 5})
    for (const int f : {0, 2}) axes.push_back(on(story, f, s));
  EXPECT_EQ(names(s, axes), (Names{"kx_1", "kx_2to5", "kx_6", "ky_1", "ky_2to5", "ky_6"}));
}

TEST(StoryGroups, DirectionsMayBeMeasuredOnOtherFloors) {
  const Structure s = building(FloorModel::rigid);
  const std::vector<SensorAxis> axes{at(3, 0, 4, 0), at(6, 0, 4, 0), at(6, 6, 0, M_PI / 2)};
  EXPECT_EQ(names(s, axes), (Names{"kx_1to3", "kx_4to6", "ky_1to6"}));
}

TEST(StoryGroups, EveryFrameOfFlexibleFloorsHasItsOwn) {
  const Structure s = building(FloorModel::flexible);
  std::vector<SensorAxis> axes{on(2, 0, s), on(6, 0, s), on(6, 1, s), on(3, 2, s)};
  EXPECT_EQ(names(s, axes),
            (Names{"kx_1to2_y1", "kx_3to6_y1", "kx_1to6_y2", "ky_1to3", "ky_4to6"}));
}

TEST(StoryGroups, HaveTheNameOfASingleFrame) {
  Structure s = building(FloorModel::flexible);
  s.frames_x = {"y1"};
  s.frames_y = {};
  s.span_x = s.span_y = {};
  EXPECT_EQ(names(s, {on(1, 0, s), on(6, 0, s)}), (Names{"kx_1_y1", "kx_2to6"}));
}

TEST(StoryGroups, FindTheGroupOfAStory) {
  const Structure s = building(FloorModel::rigid);
  const ParameterTable table(s, story_groups(s, {at(3, 0, 4, 0), at(6, 0, 4, 0)}), {4e9, 0});
  EXPECT_EQ(table[table.frame_stiffness(3, 1)].name, "kx_1to3");
  EXPECT_EQ(table[table.frame_stiffness(4, 0)].name, "kx_4to6");
  EXPECT_EQ(table.frame_stiffness(4, 2), -1);
  EXPECT_EQ(table[table.size() - 1].name, "krx");
  EXPECT_EQ(table[table.frame_damping(4, 0)].name, "cx_4to6");
}

TEST(FrameWeights, FollowTheRigidMotion) {
  const Structure s = building(FloorModel::rigid);
  const double theta = 0.01;  // about the first corner
  const std::vector<double> turned{0, -8 * theta, 0, 12 * theta};
  const auto reads = [&](const SensorAxis& axis) {
    const std::vector<double> w = frame_weights(s, axis);
    double sum = 0;
    for (std::size_t f = 0; f < 4; ++f) sum += w[f] * turned[f];
    return sum;
  };
  EXPECT_NEAR(reads(at(1, 3, 2, 0)), -2 * theta, 1e-15);
  EXPECT_NEAR(reads(at(1, 3, 2, M_PI / 2)), 3 * theta, 1e-15);
  EXPECT_NEAR(reads(at(1, 20, -4, M_PI / 4)), std::sqrt(0.5) * 24 * theta, 1e-15);
}

TEST(FrameWeights, ReachTheRotationFromTheOtherDirection) {
  Structure s = building(FloorModel::rigid);
  s.frames_x = {"y1"};
  s.span_y = {};
  const std::vector<double> w = frame_weights(s, at(1, 0, 6, 0));
  const double theta = 0.01;
  EXPECT_NEAR(w[0] * 0 + w[1] * 0 + w[2] * 12 * theta, -6 * theta, 1e-15);
}

}  // namespace story_groups_test
}  // namespace framewatch::estimator
