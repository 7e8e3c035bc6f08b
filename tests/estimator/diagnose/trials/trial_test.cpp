// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/trial.h"

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace trial_test {

TEST(SameSpot, AStoryIsPartOfItsFrame) {
  EffectPlace whole;
  whole.kind = PlaceKind::whole_frame;
  whole.frame = 1;
  EXPECT_TRUE(same_spot(whole, test::in_frame(1)));
  EXPECT_TRUE(same_spot(test::in_frame(1), whole));
  EXPECT_FALSE(same_spot(whole, test::in_frame(2)));
  EXPECT_FALSE(same_spot(whole, test::at_channel(1)));
}

TEST(SameSpot, AForceAtTheFirstFloorEqualsOneOnItsFrame) {
  EXPECT_TRUE(same_spot(test::in_frame(1), test::at_node(1)));
  EffectPlace upper = test::at_node(1), frame = test::in_frame(1);
  upper.story = frame.story = 2;
  EXPECT_FALSE(same_spot(frame, upper));
}

TEST(SameSpot, AStopToTheGroundIsAtItsFloor) {
  EffectPlace floor = test::at_node(1), stop;
  floor.story = 3;
  stop = floor;
  stop.kind = PlaceKind::node_pair;
  EXPECT_TRUE(same_spot(stop, floor));
  stop.to_story = 1;
  EXPECT_FALSE(same_spot(stop, floor));
}

TEST(CommonFrame, IsTheFrameOfTwoStories) {
  Trial pair;
  pair.place = test::in_frame(2);
  EXPECT_EQ(common_frame(pair), -1);
  EffectPlace upper = test::in_frame(2);
  upper.story = 2;
  pair.second = {EffectKind::quadratic_stiffness, upper};
  EXPECT_EQ(common_frame(pair), 2);
  pair.second->second.frame = 3;
  EXPECT_EQ(common_frame(pair), -1);
  pair.second->second = test::at_node(2);
  EXPECT_EQ(common_frame(pair), -1);
}

}  // namespace trial_test
}  // namespace framewatch::estimator
