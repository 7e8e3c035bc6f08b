// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/round_trials.h"

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace round_trials_test {

using test::HandMade;

constexpr int kFrame = 1, kChannel = 2;
constexpr double kStiff_npm = 2e6, kGain = 0.3;

Effect yielding() {
  Effect out = make_effect(EffectKind::bouc_wen, test::in_frame(kFrame));
  out.set("kh_npm", kStiff_npm);
  out.set("dy_m", 1e-3);
  return out;
}

/// Returns a spring found where the structure yields.
FoundEffect find_spring(HandMade& made) {
  ModelEffect spring;
  spring.form = LawForm::power;
  spring.place = test::in_frame(kFrame);
  spring.deformation = 5e-3;
  spring.rate = 0.1;
  spring.parameters = {linear_parameter(-1e3, 100), fixed_parameter(2)};
  Model model = made.now.model;
  model.effects.push_back(spring);
  made.now = made.recorded.fitter.fit(model, {}, thorough(model, 8));
  FoundEffect out;
  out.index = 0;
  out.chosen.place = spring.place;
  return out;
}

Located located_beside_the_spring(HandMade& made) {
  const FoundEffect found = find_spring(made);
  EXPECT_TRUE(made.now.good);
  Located out = locate(made.recorded.fitter, made.now, made.one_after_another);
  EXPECT_FALSE(out.places.empty());
  relocate_beside(made.context(), {found}, out);
  return out;
}

TEST(PlacesBesideALaw, AreNotTriedIfOnlyTheLawsShapeIsWrong) {
  HandMade made(test::records_with({yielding()}));
  const Located located = located_beside_the_spring(made);
  for (const Localisation& place : located.places)
    EXPECT_EQ(place.candidate_places.front().place, test::in_frame(kFrame));
}

TEST(PlacesBesideALaw, AreTriedForAnotherEffect) {
  std::vector<Eigen::MatrixXd> records = test::records_with({yielding()});
  records[0].col(kChannel) *= 1 + kGain;
  HandMade made(records);
  const Located located = located_beside_the_spring(made);
  ASSERT_FALSE(located.places.empty());
  EXPECT_EQ(located.places.front().candidate_places.front().place, test::at_channel(kChannel));
}

TEST(AWholeFrame, IsNotTriedInASingleStory) {
  HandMade made;
  Located located;
  located.places.push_back(made.recorded.freed(test::in_frame(kFrame)));
  EXPECT_TRUE(trials_of_whole_frame(made.context(), located, -1).empty());
}

}  // namespace round_trials_test
}  // namespace framewatch::estimator
