#include "estimator/diagnose/trials/select_trial.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "estimator/diagnose/trials/trials.h"
#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace in_its_stead_test {

constexpr double kSure = 0.9;

/// A cubic spring, and laws that were tried at its place.
struct Tried {
  test::HandMade made{test::records_with(
      {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e10})}, {1, 2})};
  std::vector<Trial> trials = try_places(made.context(), {made.recorded.freed(test::in_frame(1))});

  /// Found under the first name for which `is` holds, with the others as alternatives.
  FoundEffect found(bool cubic) {
    const auto chosen = std::find_if(trials.begin(), trials.end(), [&](const Trial& t) {
      return t.outcome == TrialOutcome::fitted && !t.model.effects.empty() &&
             t.model.effects.back().element_law() &&
             (t.kind == EffectKind::cubic_stiffness) == cubic;
    });
    FoundEffect out;
    out.chosen = *chosen;
    out.alternatives = trials;
    out.confidence = 0.99;
    out.index = 0;
    made.now = made.recorded.fitter.fit(chosen->model, {}, thorough(chosen->model, 0));
    return out;
  }
};

TEST(LawsInItsStead, TheBetterOneStays) {
  Tried tried;
  FoundEffect effect = tried.found(false);
  FitResult now = tried.made.now;
  const double before = now.cost;
  EXPECT_TRUE(choose_replacement(tried.made.context(), effect, now));
  EXPECT_EQ(effect.chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_EQ(effect.index, 0);
  EXPECT_LT(now.cost, before);
}

TEST(LawsInItsStead, TheRightOneStaysAndIsSure) {
  Tried tried;
  FoundEffect effect = tried.found(true);
  FitResult now = tried.made.now;
  EXPECT_FALSE(choose_replacement(tried.made.context(), effect, now));
  EXPECT_EQ(effect.chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_GT(effect.confidence, kSure);
}

}  // namespace in_its_stead_test
}  // namespace framewatch::estimator
