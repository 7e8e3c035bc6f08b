// SPDX-License-Identifier: MIT
#include "estimator/shaking/placard.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace placard_test {

constexpr double kExact = 1e-12;
const Fragility kFrame{{0.005, 0.01, 0.03, 0.08}, {0.4, 0.4, 0.4, 0.4}};

TEST(Fragility, IsOneHalfAtTheMedianForAnyError) {
  for (const double error : {0.0, 0.001, 0.01})
    for (std::size_t state = 0; state < kDamageStates; ++state)
      EXPECT_NEAR(damage_probabilities(kFrame, kFrame.median[state], error)[state], 0.5, kExact);
}

TEST(Fragility, IsALognormalDistribution) {
  // One dispersion above the median: Phi(1).
  EXPECT_NEAR(damage_probabilities(kFrame, 0.01 * std::exp(0.4), 0)[1], 0.841344746068543, kExact);
  // The error widens it: sqrt(0.4^2 + ln(1 + 0.5^2)).
  const double spread = std::sqrt(0.16 + std::log(1.25));
  const double drift = 0.01 * std::exp(spread);
  EXPECT_NEAR(damage_probabilities(kFrame, drift, 0.5 * drift)[1], 0.841344746068543, kExact);
}

TEST(Fragility, AWorseStateIsNeverLikelier) {
  Fragility crossing = kFrame;
  crossing.dispersion = {0.1, 0.1, 1.4, 0.1};
  for (const double drift : {1e-5, 0.002, 0.006, 0.02, 0.5}) {
    const auto p = damage_probabilities(crossing, drift, 0);
    for (std::size_t state = 1; state < kDamageStates; ++state) EXPECT_LE(p[state], p[state - 1]);
  }
  EXPECT_TRUE(std::isnan(damage_probabilities(kFrame, kNaN, 0)[0]));
}

StoryDrift drifted(int story, double ratio, double error = 0) {
  StoryDrift out;
  out.story = story;
  out.frame = std::isfinite(ratio) ? 0 : -1;
  out.ratio = ratio;
  out.std_error = error;
  out.measured = true;
  return out;
}

PlacardChoice placard_of(const std::vector<StoryDrift>& drifts, const PlacardRules& rules = {}) {
  return choose_placard(drifts, story_damage(drifts, {drifts.size(), kFrame}), rules);
}

TEST(Placard, FollowsTheWorstStory) {
  EXPECT_EQ(placard_of({drifted(1, 0.002), drifted(2, 0.003)}).placard, Placard::inspected);
  const PlacardChoice restricted = placard_of({drifted(1, 0.002), drifted(2, 0.01)});
  EXPECT_EQ(restricted.placard, Placard::restricted);
  EXPECT_EQ(restricted.story, 2);
  EXPECT_EQ(restricted.state, DamageState::moderate);
  EXPECT_NEAR(restricted.probability, 0.5, kExact);
  EXPECT_TRUE(restricted.judged);
  const PlacardChoice unsafe = placard_of({drifted(1, 0.03), drifted(2, 0.01)});
  EXPECT_EQ(unsafe.placard, Placard::unsafe);
  EXPECT_EQ(unsafe.story, 1);
  EXPECT_EQ(unsafe.state, DamageState::extensive);
}

TEST(Placard, FollowsTheThresholds) {
  const std::vector<StoryDrift> one{drifted(1, 0.01)};
  EXPECT_EQ(placard_of(one, {0.49, 0.5}).placard, Placard::restricted);
  EXPECT_EQ(placard_of(one, {0.51, 0.5}).placard, Placard::inspected);
}

TEST(Placard, IsAtBestRestrictedWithAnUnjudgedStory) {
  const PlacardChoice unknown = placard_of({drifted(1, 0.002), drifted(2, kNaN, kNaN)});
  EXPECT_EQ(unknown.placard, Placard::restricted);
  EXPECT_EQ(unknown.reason, PlacardReason::drift_unknown);
  EXPECT_FALSE(unknown.judged);
  EXPECT_EQ(unknown.story, 2);
  StoryDrift gap = drifted(1, 0.002);
  gap.unseen_share = StoryDrift::kUnseen;
  EXPECT_EQ(placard_of({gap}).placard, Placard::restricted);
  EXPECT_EQ(placard_of({gap}).reason, PlacardReason::interruption);
  EXPECT_EQ(placard_of({drifted(1, 0.002, kNaN)}).reason, PlacardReason::error_unknown);
  EXPECT_EQ(placard_of({drifted(1, 0.002, kNaN)}).placard, Placard::restricted);
}

TEST(Placard, IsUnsafeByOneStoryDespiteUnknownOthers) {
  const PlacardChoice c = placard_of({drifted(1, 0.05), drifted(2, kNaN, kNaN)});
  EXPECT_EQ(c.placard, Placard::unsafe);
  EXPECT_FALSE(c.judged);
  EXPECT_EQ(c.not_judged, std::vector<int>{2});
}

TEST(Placard, AStoryThatDidNotDriftIsNotDamaged) {
  EXPECT_EQ(placard_of({drifted(1, 0)}).placard, Placard::inspected);
}

}  // namespace placard_test
}  // namespace framewatch::estimator
