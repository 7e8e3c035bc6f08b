// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/diagnose.h"
#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/hidden_effect.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace large_building_test {

/// Eleven stories whose masses differ slightly from those of the design.
TEST(LargeBuilding, ReportsNoEffectForMassesWithinTolerance) {
  constexpr double kTolerance = 0.01;
  const test::Small described = test::tower(11);
  test::Small real = described;
  Random random{3};
  for (double& mass : real.structure.node_mass) mass *= 1 + kTolerance * random.normal();
  const Plant plant = described.plant();
  ASSERT_TRUE(plant.is_large());
  const auto segments = described.segments({real.record({}, 1), real.record({}, 2)});
  const Diagnosis d = diagnose(plant, segments, test::held_out_from(1));
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_TRUE(d.effects.empty());
}

}  // namespace large_building_test
}  // namespace framewatch::estimator
