
#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace run_columns_test {

using Eigen::Index;
using Eigen::VectorXd;
using Kind = Unknown::Kind;
using test::Small;

constexpr int kFrame = 2, kOther = 0;  // parallel to y, to x

struct Case {
  Small small;
  Plant plant = small.plant();
  test::EffectTwins twins = test::cubic_spring(kFrame, 2e11);
  Model model = test::with_effects(test::true_model(small, plant), {twins.modelled});
};

Unknown unknown_of(Kind kind, int index) {
  Unknown out{kind, index};
  return out;
}

TEST(RunColumns, WhatMovesARunIsAlongItsLaws) {
  Case c;
  const auto moves = [&](Kind kind, int index) {
    return moves_run(c.plant, c.model, unknown_of(kind, index));
  };
  EXPECT_TRUE(moves(Kind::theta, c.plant.table.frame_stiffness(1, kFrame)));
  EXPECT_TRUE(moves(Kind::theta, c.plant.table.frame_stiffness(1, 3)));  // beside it
  EXPECT_FALSE(moves(Kind::theta, c.plant.table.frame_stiffness(1, kOther)));
  EXPECT_FALSE(moves(Kind::theta, c.plant.table.frame_damping(1, kFrame)));
  EXPECT_FALSE(moves(Kind::theta, c.plant.table.panel_stiffness(1, 0)));
  EXPECT_TRUE(moves(Kind::mass, kFrame));
  EXPECT_FALSE(moves(Kind::mass, kOther));
  EXPECT_FALSE(moves(Kind::gain, kFrame));
  EXPECT_FALSE(moves(Kind::clock, kFrame));
  EXPECT_TRUE(moves(Kind::parameter, 0));
  EXPECT_TRUE(moves(Kind::record_parameter, 0));
  c.model.effects.clear();
  EXPECT_FALSE(moves(Kind::theta, c.plant.table.frame_stiffness(1, kFrame)));
  // A law of a panel goes with both directions.
  c.model.effects = {test::effect_of(LawForm::friction, test::panel_place(0), {10, 1e-3})};
  EXPECT_TRUE(moves(Kind::theta, c.plant.table.frame_stiffness(1, kOther)));
}

/// With derivatives through it, the equations change as their run does.
TEST(RunColumns, AreTheDerivativesOfTheRun) {
  constexpr double kTolerance = 0.02;
  constexpr double kDifference = 1e-3;  // of a stiffness, of its design
  const Case c;
  const RecordSegment segment =
      c.small.segments({test::exact_record(c.small, {c.twins.simulated}, 1)}).front();
  const int ratio = steps_per_sample(c.plant, segment.rate_hz);
  Whitened at = whiten(c.plant, c.model, segment, 0, Forcing::simulated, {}, ratio);
  ASSERT_TRUE(at.good);
  at.motion = at.calibrated;
  const auto residual = [&](const Unknown& u, double change) {
    Model moved = c.model;
    set_value(moved, u, value_of(c.model, u) + change);
    auto tracks = tracks_of(c.plant, moved, segment, 0, Forcing::simulated, {}, ratio);
    return whiten(c.plant, moved, segment, 0, std::move(*tracks), ratio, at.weights).residual;
  };
  const std::vector<Unknown> all = unknowns_of(c.plant, c.model, {0, 0, 0});
  for (const bool through_run : {true, false}) {
    const Columns columns = columns_of(c.plant, c.model, segment, 0, at, all, ratio, through_run);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!moves_run(c.plant, c.model, all[i])) continue;
      const double change = all[i].kind == Kind::theta ? kDifference : 1;
      const VectorXd expected =
          (residual(all[i], change) - residual(all[i], -change)) / (2 * change);
      const double miss =
          (whole_column(c.plant, at, columns, static_cast<Index>(i)) - expected).norm() /
          expected.norm();
      if (through_run)
        EXPECT_LT(miss, kTolerance) << i;
      else
        EXPECT_GT(miss, kTolerance) << i;
    }
  }
}

TEST(RunColumns, ThereIsNoneWhereTheChangedModelRunsAway) {
  Case c;
  const RecordSegment segment = c.small.segments({test::exact_record(c.small, {}, 1)}).front();
  c.model.effects = {test::effect_of(LawForm::power, test::frame_place(kFrame), {0, 1})};
  const Whitened at = whiten(c.plant, c.model, segment, 0, Forcing::simulated, {}, 2);
  ASSERT_TRUE(at.good);
  Unknown stiffness = unknown_of(Kind::parameter, 0);
  stiffness.scale = 1e4;
  EXPECT_TRUE(run_column(c.plant, c.model, segment, 0, at, stiffness, 2));
  stiffness.scale = -1e9;
  EXPECT_FALSE(run_column(c.plant, c.model, segment, 0, at, stiffness, 2));
}

}  // namespace run_columns_test
}  // namespace framewatch::estimator
