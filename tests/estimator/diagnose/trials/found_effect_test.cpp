// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/found_effect.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace found_effect_test {

using test::HandMade;

TEST(EffectOf, TakesTheBestTrialAndKeepsRivals) {
  const HandMade made;
  const std::vector<Trial> trials{made.trial(EffectKind::cubic_stiffness, 500),
                                  made.trial(EffectKind::cubic_stiffness, 490),
                                  made.trial(EffectKind::bouc_wen, 400)};
  const FoundEffect found = effect_of({}, trials);
  EXPECT_EQ(found.chosen.kind, EffectKind::cubic_stiffness);
  ASSERT_EQ(found.alternatives.size(), 1U) << "the same from another start is no other";
  EXPECT_EQ(found.alternatives[0].kind, EffectKind::bouc_wen);
  EXPECT_TRUE(found.like.empty());
}

TEST(EffectOf, IsAsConfidentAsTheBestRivalIsFar) {
  const HandMade made;
  const auto confidence = [&](double margin) {
    return effect_of({}, {made.trial(EffectKind::cubic_stiffness, 500),
                          made.trial(EffectKind::bouc_wen, 500 - margin)})
        .confidence;
  };
  EXPECT_NEAR(confidence(20), 1 - 0.5 * std::exp(-1), 1e-12);
  EXPECT_NEAR(confidence(1000), 0.999, 1e-12);
  EXPECT_NEAR(effect_of({}, {made.trial(EffectKind::cubic_stiffness, 500)}).confidence, 0.999,
              1e-12);
}

TEST(EffectOf, ListsEquallyGoodNames) {
  const HandMade made;
  const FoundEffect found =
      effect_of({}, {made.trial(EffectKind::cubic_stiffness, 500),
                     made.trial(EffectKind::bouc_wen, 495), made.trial(EffectKind::pinching, 480)});
  ASSERT_EQ(found.like.size(), 1U);
  EXPECT_EQ(found.like[0], EffectKind::bouc_wen);
  EXPECT_DOUBLE_EQ(found.confidence, 0.5);
}

TEST(NearRivals, AreThoseThatKeepTheConfidenceLow) {
  const HandMade made;
  const auto found = [&](double margin) {
    return effect_of({}, {made.trial(EffectKind::cubic_stiffness, 500),
                          made.trial(EffectKind::bouc_wen, 500 - margin),
                          made.trial(EffectKind::pinching, 300)});
  };
  constexpr double kSure = 0.95;
  const double limit = 20 * std::log(0.5 / (1 - kSure));
  const FoundEffect near = found(limit - 1);
  ASSERT_EQ(near_rivals({}, near, kSure).size(), 1U);
  EXPECT_EQ(near_rivals({}, near, kSure)[0]->kind, EffectKind::bouc_wen);
  EXPECT_LT(near.confidence, kSure);
  EXPECT_TRUE(near_rivals({}, found(limit + 1), kSure).empty());
  EXPECT_GT(found(limit + 1).confidence, kSure);
  FoundEffect together = near;  // its own trial says nothing
  together.chosen.fraction = std::nan("");
  EXPECT_TRUE(near_rivals({}, together, kSure).empty());
}

}  // namespace found_effect_test
}  // namespace framewatch::estimator
