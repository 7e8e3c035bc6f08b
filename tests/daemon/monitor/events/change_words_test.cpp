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

TEST(ChangeWords, ALossOfAGroupIsALargerOneOfAStory) {
  constexpr double kLoss = 0.02;
  const estimator::Parameter four = frames(5, 8), one = frames(5, 5);
  EXPECT_NEAR(loss_of_one_story(four, kLoss), 0.0755, 1e-4);  // springs in series
  EXPECT_NEAR(loss_of_group(four, loss_of_one_story(four, kLoss)), kLoss, 1e-12);
  EXPECT_EQ(loss_of_one_story(one, kLoss), kLoss);
  EXPECT_EQ(loss_of_one_story(four, 1), 1);
  EXPECT_EQ(loss_of_one_story(four, 0), 0);
}

TEST(ChangeWords, AGroupSaysWhatItMayBeOfOneStory) {
  EXPECT_EQ(change_sentence(frames(5, 8), -0.02, 0.001),
            "stories 5 to 8, along x (kx_5to8) have lost 2.0 % of their stiffness, give or take "
            "0.1 %: 20 times its uncertainty; one of stories 5 to 8 may have lost up to 8 %");
  EXPECT_EQ(change_sentence(frames(1, 1), -0.148, 0.0041),
            "story 1, frame y1 (kx_1_y1) has lost 14.8 % of its stiffness, give or take 0.4 %: 36 "
            "times its uncertainty");
}

TEST(ChangeWords, WithoutANumberItIsChanging) {
  EXPECT_EQ(changing_sentence(frames(1, 1), -0.1),
            "story 1, frame y1 (kx_1_y1) is changing: it loses stiffness, how much is not known "
            "yet");
  const std::string all = common_change_sentence(-0.05, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(all.find("nan"), std::string::npos);
  EXPECT_EQ(common_change_sentence(-0.05, 0.004).rfind("everything softened alike by 5.0 %", 0),
            0U);
}

}  // namespace change_words_test
}  // namespace framewatch::daemon
