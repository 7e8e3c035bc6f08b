// SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace fit_columns_test {

using Eigen::Index;
using Eigen::VectorXd;
using test::effect_of;
using test::Small;

constexpr double kDifference = 0.1;  // units of an unknown, in each direction
constexpr double kTolerance = 3e-3;  // of a column
constexpr double kOfOneSide = 0.02;  // of an effect's values, which use one-sided differences

/// Returns the change of the whitened residual by an unknown, with weights and law motion held.
VectorXd difference(const Plant& plant, const Model& model, const RecordSegment& segment,
                    const Whitened& at, const Unknown& unknown, int ratio) {
  const auto residual = [&](double change) {
    Model moved = model;
    set_value(moved, unknown, value_of(model, unknown) + change);
    auto tracks = tracks_of(plant, moved, segment, 0, Forcing::measured, at.motion, ratio);
    return whiten(plant, moved, segment, 0, std::move(*tracks), ratio, at.weights).residual;
  };
  return (residual(kDifference) - residual(-kDifference)) / (2 * kDifference);
}

/// True if a column leaves out this dependence: of an effect on stiffnesses, or on the readings
/// that it mixes.
bool held(const ModelEffect& effect, const Plant& plant, const Unknown& unknown) {
  switch (effect.form) {
    case LawForm::rocking:
    case LawForm::bending:
      return unknown.kind == Unknown::Kind::theta;
    case LawForm::panels:
      return unknown.kind == Unknown::Kind::theta && plant.table[unknown.index].panel >= 0;
    case LawForm::misaligned:
      return (unknown.kind == Unknown::Kind::gain || unknown.kind == Unknown::Kind::clock) &&
             (unknown.index == effect.place.channel || unknown.index == effect.place.with_channel);
    default:
      return false;
  }
}

std::vector<ModelEffect> one_of_every_form();

class FitColumns : public testing::TestWithParam<std::size_t> {};

TEST_P(FitColumns, AreTheDerivativesOfTheResidual) {
  const Small small;
  const Plant plant = small.plant();
  const RecordSegment segment = small.segments({small.record({}, 1)}).front();
  const int ratio = steps_per_sample(plant, segment);
  const ModelEffect effect = one_of_every_form()[GetParam()];
  Model model = test::with_effects(test::true_model(small, plant), {effect});
  // A point where nothing is zero.
  model.mass_change[1] = 0.01;
  model.gain[2] = -0.01;
  model.clock_s[3] = 0.4e-3;
  Whitened at = whiten(plant, model, segment, 0, Forcing::measured, {}, ratio);
  ASSERT_TRUE(at.good);
  at.motion = at.calibrated;
  const std::vector<Unknown> unknowns = unknowns_of(plant, model, {});
  const Columns columns = columns_of(plant, model, segment, 0, at, unknowns, ratio, false);
  ASSERT_EQ(columns.count(), static_cast<Index>(unknowns.size()));
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    if (held(effect, plant, unknowns[u])) continue;
    const VectorXd expected = difference(plant, model, segment, at, unknowns[u], ratio);
    const VectorXd column = whole_column(plant, at, columns, static_cast<Index>(u));
    EXPECT_GT(expected.norm(), 0) << u;
    const bool linear = unknowns[u].kind < Unknown::Kind::parameter;
    EXPECT_LT((column - expected).norm(), (linear ? kTolerance : kOfOneSide) * expected.norm())
        << "kind " << static_cast<int>(unknowns[u].kind) << ", index " << unknowns[u].index
        << ", parameter " << unknowns[u].parameter;
  }
}

std::vector<ModelEffect> one_of_every_form() {
  const auto frame = test::frame_place(2);
  const auto node = test::node_place(1);
  const auto building = test::building_place(Direction::x);
  std::vector<ModelEffect> out = {
      effect_of(LawForm::power, frame, {5e3, 2.6}),
      effect_of(LawForm::hysteresis, frame, {2e6, 3e-3, 2, 0.6}),
      effect_of(LawForm::pinched, frame, {2e6, 3e-3, 2, 0.6, 0.5, 0.3}),
      effect_of(LawForm::friction, frame, {2e3, 5e-3}),
      effect_of(LawForm::power_damping, frame, {4e3, 1.8}),
      effect_of(LawForm::gap_positive, frame, {3e6, 2e-3}),
      effect_of(LawForm::gap_negative, frame, {3e6, 2e-3}),
      effect_of(LawForm::gap_both, frame, {3e6, 2e-3}),
      effect_of(LawForm::changing, frame, {-4e5}, {6, 8}),
      effect_of(LawForm::mass, test::crossing_place(3), {800}),
      effect_of(LawForm::resonator, node, {700, 2.3, 0.1}),
      effect_of(LawForm::spring, test::pair_place(0), {3e5}),
      effect_of(LawForm::damper, test::pair_place(0), {4e4}),
      effect_of(LawForm::rocking, building, {1e-9}),
      effect_of(LawForm::bending, building, {1e-9}),
      effect_of(LawForm::panels, test::floor_place(), {3e6, 2e4}),
      effect_of(LawForm::harmonic, node, {2.9}, {800, -500}),
      effect_of(LawForm::misaligned, test::channel_place(0, 2), {0.08}),
  };
  out[0].deformation = 0.01;
  out[4].rate = 0.1;
  out[16].parameters[0].step = 2e-5;  // Hz: its phase grows over the record
  return out;
}

INSTANTIATE_TEST_SUITE_P(OfEveryForm, FitColumns,
                         testing::Range(std::size_t{0}, one_of_every_form().size()));

TEST(FitColumnsOfRecords, DependOnlyOnTheRecordsOwnValues) {
  const Small small;
  const Plant plant = small.plant();
  const std::vector<RecordSegment> segments = small.segments({small.record({}, 1)});
  ModelEffect drift = effect_of(LawForm::changing, test::frame_place(2), {-4e5}, {6, 8});
  drift.record_parameters.push_back(drift.record_parameters.front());
  const Model model = test::with_effects(test::true_model(small, plant), {drift});
  const Fitter fitter(plant, segments, {});
  const Linearised at = fitter.linearise(model, fitter.systems(model, {}, Forcing::measured));
  int others = 0;
  for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
    const bool other =
        at.unknowns[u].kind == Unknown::Kind::record_parameter && at.unknowns[u].record == 1;
    const VectorXd column =
        whole_column(plant, at.systems[0], at.columns[0], static_cast<Index>(u));
    EXPECT_EQ(column.isZero(0), other);
    others += other;
  }
  EXPECT_EQ(others, 2);
}

using Kind = Unknown::Kind;

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

TEST(RunColumns, OnlyUnknownsNextToALawMoveARun) {
  Case c;
  const auto moves = [&](Kind kind, int index) {
    return moves_run(c.plant, c.model, unknown_of(kind, index));
  };
  EXPECT_TRUE(moves(Kind::theta, c.plant.table.frame_stiffness(1, kFrame)));
  EXPECT_TRUE(moves(Kind::theta, c.plant.table.frame_stiffness(1, 3)));  // next to it
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
  // A law of a panel moves with both directions.
  c.model.effects = {test::effect_of(LawForm::friction, test::panel_place(0), {10, 1e-3})};
  EXPECT_TRUE(moves(Kind::theta, c.plant.table.frame_stiffness(1, kOther)));
}

/// With derivatives through the run, the equations change as their run does.
TEST(RunColumns, AreTheDerivativesOfTheRun) {
  constexpr double kMaxMiss = 0.02;
  constexpr double kStep = 1e-3;  // of a stiffness, of its design
  const Case c;
  const RecordSegment segment =
      c.small.segments({test::exact_record(c.small, {c.twins.simulated}, 1)}).front();
  const int ratio = steps_per_sample(c.plant, segment);
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
      const double change = all[i].kind == Kind::theta ? kStep : 1;
      const VectorXd expected =
          (residual(all[i], change) - residual(all[i], -change)) / (2 * change);
      const double miss =
          (whole_column(c.plant, at, columns, static_cast<Index>(i)) - expected).norm() /
          expected.norm();
      if (through_run)
        EXPECT_LT(miss, kMaxMiss) << i;
      else
        EXPECT_GT(miss, kMaxMiss) << i;
    }
  }
}

TEST(RunColumns, DoNotExistIfTheChangedModelDiverges) {
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

}  // namespace fit_columns_test

}  // namespace framewatch::estimator
