// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace unknowns_test {

using Kind = Unknown::Kind;
using test::Small;

long count(const std::vector<Unknown>& unknowns, Kind kind) {
  return std::count_if(unknowns.begin(), unknowns.end(),
                       [&](const Unknown& u) { return u.kind == kind; });
}

/// Returns a drift of two records with a held parameter.
Model with_drift(const Plant& plant) {
  ModelEffect drift = test::effect_of(LawForm::changing, test::frame_place(3), {-4e5}, {3, 2});
  drift.record_parameters.push_back({test::parameter_of(5), test::parameter_of(1)});
  drift.record_parameters[1][1].free = false;
  return test::with_effects(initial_model(plant), {drift});
}

TEST(Unknowns, DependOnTolerancesAndModel) {
  struct Case {
    Tolerances tolerances;
    long mass, gain, clock;
  };
  const Plant plant = Small().plant();
  for (const Case& c : {Case{{}, 4, 6, 6}, Case{{0, 0.01, 1e-3}, 0, 6, 6},
                        Case{{0.01, 0, 1e-3}, 4, 0, 6}, Case{{0, 0, 0}, 0, 0, 0}}) {
    const std::vector<Unknown> all = unknowns_of(plant, with_drift(plant), c.tolerances);
    EXPECT_EQ(count(all, Kind::theta), 10);
    EXPECT_EQ(count(all, Kind::mass), c.mass);
    EXPECT_EQ(count(all, Kind::gain), c.gain);
    EXPECT_EQ(count(all, Kind::clock), c.clock);
    EXPECT_EQ(count(all, Kind::parameter), 1);
    EXPECT_EQ(count(all, Kind::record_parameter), 3);
  }
}

TEST(Unknowns, LeaveOutPanelsOfARigidFloor) {
  const Plant plant = test::rigid_small().plant();
  const std::vector<Unknown> all = unknowns_of(plant, initial_model(plant), {});
  EXPECT_EQ(count(all, Kind::theta), 8);
  for (const Unknown& u : all) {
    if (u.kind == Kind::theta) {
      EXPECT_LT(plant.table[u.index].panel, 0);
    }
  }
}

TEST(Unknowns, ErrorsModelledAsEffectsAreUnbounded) {
  const Plant plant = Small().plant();
  Model model = initial_model(plant);
  model.free_gain = {2};
  model.free_clock = {5};
  for (const Tolerances& tolerances : {Tolerances{}, Tolerances{0, 0, 0}}) {
    int freed = 0;
    for (const Unknown& u : unknowns_of(plant, model, tolerances)) {
      if (u.kind != Kind::gain && u.kind != Kind::clock) continue;
      const bool free = u.index == (u.kind == Kind::gain ? 2 : 5);
      EXPECT_EQ(std::isinf(u.high), free);
      EXPECT_EQ(std::isinf(u.low), free);
      EXPECT_EQ(u.sigma == 0, free);
      freed += free;
    }
    EXPECT_EQ(freed, 2);
  }
}

TEST(Unknowns, StartAtThePriorMean) {
  Small small;
  small.axes[1].delay = 0.003;
  const Plant plant = small.plant();
  const Model model = initial_model(plant);
  for (const Unknown& u : unknowns_of(plant, model, {})) {
    EXPECT_NEAR(value_of(model, u), u.center, 1e-12) << u.index;
    EXPECT_LT(u.low, u.center);
    EXPECT_GT(u.high, u.center);
    EXPECT_GT(u.sigma, 0);
  }
}

TEST(Unknowns, AreReadAndWrittenInTheirUnits) {
  constexpr double kChange = 0.37;
  const Plant plant = Small().plant();
  const Model model = with_drift(plant);
  for (const Unknown& u : unknowns_of(plant, model, {})) {
    Model changed = model;
    const double before = value_of(model, u);
    set_value(changed, u, before + kChange);
    EXPECT_NEAR(value_of(changed, u), before + kChange, 1e-9);
    set_value(changed, u, before);
    // Nothing else has changed.
    for (const Unknown& other : unknowns_of(plant, model, {}))
      EXPECT_NEAR(value_of(changed, other), value_of(model, other), 1e-9);
  }
}

TEST(Unknowns, StayWithinTheirBounds) {
  const Plant plant = Small().plant();
  Model model = with_drift(plant);
  model.effects[0].parameters[0].low = -6e5;
  model.effects[0].parameters[0].high = 0;
  for (const Unknown& u : unknowns_of(plant, model, {}))
    for (const double far : {-1e9, 1e9}) {
      const double bound = far < 0 ? u.low : u.high;
      if (std::abs(bound) > 1e9) continue;
      set_value(model, u, far);
      EXPECT_NEAR(value_of(model, u), bound, 1e-9 * (1 + std::abs(bound)));
    }
  EXPECT_EQ(model.effects[0].parameters[0].value, 0);
  EXPECT_GT(model.theta.minCoeff(), 0);
}

}  // namespace unknowns_test
}  // namespace framewatch::estimator
