// SPDX-License-Identifier: MIT
#include "daemon/monitor/events/change_words.h"

#include <limits>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace change_words_test {

estimator::Parameter frames(int first, int last) {
  estimator::Parameter p{};
  p.name = first == last ? "kx_" + std::to_string(first) + "_y1"
                         : "kx_" + std::to_string(first) + "to" + std::to_string(last);
  p.kind = estimator::ParameterKind::frame_stiffness;
  p.story = first;
  p.last_story = last;
  return p;
}

TEST(ChangeWords, ALossOfAGroupMeansALargerLossOfAStory) {
  constexpr double kLoss = 0.02;
  const estimator::Parameter four = frames(5, 8), one = frames(5, 5);
  EXPECT_NEAR(loss_of_one_story(four, kLoss), 0.0755, 1e-4);  // springs in series
  EXPECT_NEAR(loss_of_group(four, loss_of_one_story(four, kLoss)), kLoss, 1e-12);
  EXPECT_EQ(loss_of_one_story(one, kLoss), kLoss);
  EXPECT_EQ(loss_of_one_story(four, 1), 1);
  EXPECT_EQ(loss_of_one_story(four, 0), 0);
}

TEST(ChangeWords, AGroupsLossGivesThePossibleLossOfOneStory) {
  EXPECT_EQ(change_sentence(frames(5, 8), -0.02, 0.001, {}),
            "stories 5 to 8, along x (kx_5to8) have lost 2.0 % of their stiffness, give or take "
            "0.1 %: 20 times its uncertainty; one of stories 5 to 8 may have lost up to 8 %");
  EXPECT_EQ(change_sentence(frames(1, 1), -0.148, 0.0041, {}),
            "story 1, frame y1 (kx_1_y1) has lost 14.8 % of its stiffness, give or take 0.4 %: 36 "
            "times its uncertainty");
  EXPECT_EQ(change_sentence(frames(1, 1), -0.148, 0.0041, {{"y1", "south wall"}}),
            "story 1, south wall (kx_1_y1) has lost 14.8 % of its stiffness, give or take 0.4 %: "
            "36 times its uncertainty");
}

TEST(ChangeWords, WithoutANumberItIsChanging) {
  EXPECT_EQ(changing_sentence(frames(1, 1), -0.1, {}),
            "story 1, frame y1 (kx_1_y1) is changing: it loses stiffness, how much is not known "
            "yet");
  const std::string all = common_change_sentence(-0.05, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(all.find("nan"), std::string::npos);
  EXPECT_EQ(common_change_sentence(-0.05, 0.004).rfind("everything softened alike by 5.0 %", 0),
            0U);
}

}  // namespace change_words_test

namespace {

TEST(PlaceWords, DescribeThePlaceOfAParameter) {
  EXPECT_EQ(place_words("kx_1_y2"), "story 1, frame y2");
  EXPECT_EQ(place_words("Gk_2_x1y1"), "floor 2, panel x1y1");
  EXPECT_EQ(place_words("kx_6to12"), "stories 6 to 12, along x");
  EXPECT_EQ(place_words("cy_13"), "story 13, along y");
  EXPECT_EQ(place_words("ky_6to12_x1"), "stories 6 to 12, frame x1");
  EXPECT_EQ(place_words("kx_1to5_y1+y2"), "stories 1 to 5, frames y1+y2");
  EXPECT_EQ(place_words("kx_1_y_2"), "story 1, frame y_2") << "names of frames may hold a _";
  EXPECT_EQ(place_words("kry"), "frames along y");
}

TEST(ChangeWords, FramesHaveTheLabelsThatPeopleGave) {
  estimator::Structure s;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1"};
  s.labels_x = {"south wall", "north wall"};
  const FrameLabels labels = frame_labels(s);
  EXPECT_EQ(place_words("kx_1_y2", labels), "story 1, north wall");
  EXPECT_EQ(element_words("kx_1_y2", labels), "north wall (y2) of story 1");
  EXPECT_EQ(element_words("cx_2to4_y1", labels), "south wall (y1) of stories 2 to 4");
  EXPECT_EQ(place_words("ky_1_x1", labels), "story 1, frame x1") << "no label was given";
  EXPECT_EQ(place_words("kx_1to5_y1+y2", labels), "stories 1 to 5, frames y1+y2");
  EXPECT_EQ(named_place("kx_1_y2", labels), "story 1, north wall (kx_1_y2)");
  EXPECT_EQ(frame_words("y2", labels), "north wall");
  EXPECT_EQ(frame_words("x1", labels), "frame x1");
}

TEST(PlaceWords, DescribeTheElementOfAParameter) {
  EXPECT_EQ(element_words("kx_1_y2"), "frame y2 of story 1");
  EXPECT_EQ(element_words("Gk_2_x1y1"), "floor panel x1y1 of floor 2");
  EXPECT_EQ(element_words("kx_6to12"), "stories 6 to 12 along x");
  EXPECT_EQ(element_words("ky_6to12_x1"), "frame x1 of stories 6 to 12");
  EXPECT_EQ(element_words("krx"), "bending of frames along x");
}

TEST(PlaceWords, AcceptAnyText) {
  for (const char* name : {"", "_", "__", "k_", "k__", "_1_"}) {
    (void)place_words(name);
    (void)element_words(name);
  }
}

}  // namespace

namespace recovery_words_test {

using estimator::RecoveryLaw, estimator::RecoveryReason, estimator::RecoveryVerdict;

RecoveryLaw law_after(double time_s, double loss) {
  RecoveryLaw law;
  law.first_s = 5;
  law.first_loss = 0.09;
  law.first_error = 0.01;
  law.time_s = time_s;
  law.loss = loss;
  law.std_error = 0.01;
  law.later_s = 86400;
  law.later_loss = 0.04;
  law.later_error = 0.01;
  law.stays = 0.06;
  return law;
}

TEST(RecoveryWords, DescribeLossTimeAndExpectation) {
  RecoveryLaw law = law_after(3600, 0.06);
  law.verdict = RecoveryVerdict::recovering;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 6 % after 1 hour, recovering: 4 % (+-1 %) expected after "
            "1 day");
  law.verdict = RecoveryVerdict::lasting;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 6 % after 1 hour, lasting: full recovery is excluded, at "
            "least 6 % stays");
  law.verdict = RecoveryVerdict::recovered;
  law.time_s = 600;
  law.loss = -0.001;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 0 % (+-1 %) after 10 minutes, recovered");
}

TEST(RecoveryWords, DescribeWhyNothingIsKnown) {
  RecoveryLaw law = law_after(40, 0.08);
  law.reason = RecoveryReason::short_time;
  EXPECT_EQ(recovery_words(law),
            "lost 9 % at the earthquake, 8 % after 40 s, not known yet whether that lasts: too "
            "little time has passed");
  EXPECT_EQ(recovery_words(RecoveryLaw()),
            "not known yet whether that lasts: too few windows have come");
}

}  // namespace recovery_words_test

}  // namespace framewatch::daemon
