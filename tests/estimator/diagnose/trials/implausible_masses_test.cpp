// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/implausible_masses.h"

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace implausible_masses_test {

using test::HandMade;

constexpr int kCrossing = 1;
constexpr double kMassOff = 0.15;

std::vector<Trial> masses_of(const HandMade& made) {
  return implausible_masses(made.context(), locate(made.recorded.fitter, made.now, {}));
}

std::vector<Eigen::MatrixXd> records_with_mass(double mass_kg) {
  return test::records_with(
      {test::effect_of(EffectKind::extra_mass, test::at_crossing(kCrossing), {mass_kg})});
}

TEST(ImplausibleMasses, AreExplainedByOneExtraMass) {
  constexpr double kMass_kg = 5000;
  const HandMade made(records_with_mass(kMass_kg));
  const std::vector<Trial> trials = masses_of(made);
  ASSERT_FALSE(trials.empty());
  EXPECT_EQ(name_of(trials[0].kind), "extra_mass");
  EXPECT_EQ(trials[0].place, test::at_crossing(kCrossing));
  EXPECT_NEAR(trials[0].model.effects.back().parameters[0].plain() / kMass_kg, 1, kMassOff);
  EXPECT_LT(trials[0].cost, made.now.cost - SearchSettings().implausible_masses);
  EXPECT_GT(trials[0].fraction, 0);
  EXPECT_LE(trials[0].fraction, 1);
}

TEST(ImplausibleMasses, MassesWithinChanceAreKept) {
  const HandMade nothing;
  EXPECT_TRUE(masses_of(nothing).empty());
  // Half a percent of a frame's mass.
  const HandMade little(records_with_mass(150));
  EXPECT_TRUE(masses_of(little).empty());
}

TEST(ImplausibleMasses, ExactMassesAreNotTried) {
  const HandMade made(records_with_mass(5000), {0, 0.005, 0.25e-3});
  EXPECT_TRUE(masses_of(made).empty());
}

TEST(ImplausibleMasses, AMissingMassIsNoEffect) {
  const HandMade made(records_with_mass(-4000));
  for (const Trial& t : masses_of(made))
    EXPECT_GT(t.model.effects.back().parameters[0].plain(), 0) << name_of(t.kind);
}

TEST(ImplausibleMasses, ExcludedNamesAreNotTried) {
  HandMade made(records_with_mass(5000));
  made.without = {EffectKind::extra_mass};
  for (const Trial& t : masses_of(made)) EXPECT_NE(t.kind, EffectKind::extra_mass);
}

}  // namespace implausible_masses_test
}  // namespace framewatch::estimator
