#include <algorithm>

#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/diagnose.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace look_ahead_test {

Diagnosis diagnosed(const std::vector<Effect>& effects) {
  const test::Recorded r(test::records_with(effects, {1, 2}));
  return diagnose(r.plant, r.segments, test::held_out_from(1));
}

bool names(const Diagnosis& d, const Effect& effect) {
  return std::any_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& found) {
    return found.chosen.kind == effect.kind && found.chosen.place == effect.place;
  });
}

TEST(TwoEffects, OneOfWhichChangesWithTimeMayBeAtOnePlace) {
  const Effect friction =
      test::effect_of(EffectKind::coulomb_friction, test::in_frame(1), {9e3, 0.004});
  const Effect drop = test::effect_of(EffectKind::stiffness_drop, test::in_frame(1), {-1.6e6, 6});
  const Diagnosis d = diagnosed({friction, drop});
  EXPECT_EQ(d.effects.size(), 2U);
  EXPECT_TRUE(names(d, friction));
  EXPECT_TRUE(names(d, drop));
}

}  // namespace look_ahead_test
}  // namespace framewatch::estimator
