#include "estimator/diagnose/trials/refit.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "estimator/diagnose/trials/trials.h"
#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace needless_test {

TEST(TakesNothing, IsWhatNoMotionNeeds) {
  const test::HandMade made(test::records_with(
      {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e10})}, {1, 2}));
  const std::vector<Trial> trials =
      try_places(made.context(), {made.recorded.freed(test::in_frame(1))});
  const auto cubic = std::find_if(trials.begin(), trials.end(), [](const Trial& t) {
    return t.outcome == TrialOutcome::fitted && t.kind == EffectKind::cubic_stiffness;
  });
  ASSERT_NE(cubic, trials.end());
  const Fitter& fitter = made.recorded.fitter;
  EXPECT_FALSE(is_redundant(fitter, cubic->model, made.now.model, {}));
  Model damped = cubic->model;
  ModelEffect damper;
  damper.form = LawForm::damper;
  damper.place = test::at_node(3);
  damper.parameters = {linear_parameter(0, 1e3)};
  damped.effects.push_back(damper);
  EXPECT_TRUE(is_redundant(fitter, damped, cubic->model, {}));
}

}  // namespace needless_test
}  // namespace framewatch::estimator
