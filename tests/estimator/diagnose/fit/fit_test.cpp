// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/fit.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace fit_test {

using test::Small;

double misfit_of(const Fitter& fitter, const Model& model) {
  double out = 0;
  for (const Whitened& s : fitter.systems(model, {}, Forcing::measured)) out += s.misfit;
  return out;
}

Model with_mass(const Plant& plant) {
  Model out = initial_model(plant);
  ModelEffect mass;
  mass.form = LawForm::mass;
  mass.place.kind = PlaceKind::crossing;
  mass.place.story = 1;
  mass.place.crossing = 2;
  mass.parameters.push_back({500, false, 100});
  out.effects.push_back(mass);
  return out;
}

TEST(Fit, HoldsToleratedErrorsOnRequest) {
  const Small small;
  const Plant plant = small.plant();
  const std::vector<RecordSegment> segments = small.segments({small.record({}, 1)});
  const Fitter fitter(plant, segments, {});
  Model start = initial_model(plant);
  start.mass_change[1] = 0.004;
  start.free_gain = {2};  // an effect
  FitOptions options;
  options.holds_tolerated = true;
  const FitResult held = fitter.fit(start, {}, options);
  ASSERT_TRUE(held.good);
  EXPECT_EQ(held.model.mass_change, start.mass_change);
  EXPECT_EQ(held.model.clock_s, start.clock_s);
  EXPECT_EQ(held.model.gain[1], start.gain[1]);
  EXPECT_NE(held.model.gain[2], start.gain[2]);
  EXPECT_NE(held.model.theta, start.theta);
  // Held values contribute to the cost all the same.
  EXPECT_DOUBLE_EQ(held.cost, held.total_misfit() + fitter.prior_cost(held.model));
}

/// With a wrong gradient a fit creeps, and its residual looks like an effect.
TEST(Fit, GradientMatchesTheMisfit) {
  constexpr double kStep = 0.01;       // of an unknown's deviation
  constexpr double kTolerance = 2e-3;  // of the largest along one deviation
  const Small small;
  const Plant plant = small.plant();
  const std::vector<RecordSegment> segments = small.segments({small.record({}, 1)});
  const Fitter fitter(plant, segments, {});
  for (const Model& start : {initial_model(plant), with_mass(plant)}) {
    Model model = fitter.fit(start, {}, {}).model;
    model.theta *= 1.001;
    model.gain[1] += 0.002;
    const Linearised at = fitter.linearise(model, fitter.systems(model, {}, Forcing::measured));
    const NormalEquations equations = normal_equations(at);
    ASSERT_LT(equations.misfit, kNearNoise * fitter.expected(model));
    for (std::size_t i = 0; i < at.unknowns.size(); ++i) {
      const auto u = static_cast<Eigen::Index>(i);
      const double deviation = 1 / std::sqrt(equations.normal(u, u));
      Model more = model, less = model;
      const double value = value_of(model, at.unknowns[i]);
      set_value(more, at.unknowns[i], value + kStep * deviation);
      set_value(less, at.unknowns[i], value - kStep * deviation);
      const double slope = (misfit_of(fitter, more) - misfit_of(fitter, less)) / (2 * kStep);
      EXPECT_NEAR(2 * equations.gradient[u] * deviation, slope, kTolerance * (1 + std::abs(slope)))
          << start.effects.size() << " effects, unknown " << i;
    }
  }
}

TEST(Fit, StepsStayWithinBoundsAndOtherUnknownsAdapt) {
  Model model;
  model.theta = Eigen::Vector3d(1, 1, 1);
  std::vector<Unknown> unknowns;
  for (int i = 0; i < 3; ++i) {
    Unknown u{Unknown::Kind::theta, i};
    u.low = i == 0 ? 0.5 : -10.0;
    unknowns.push_back(u);
  }
  Eigen::Matrix3d normal;
  normal << 2, 0.9, 0, 0.9, 1, 0.2, 0, 0.2, 3;
  const Eigen::Vector3d wanted(-2, 1, 0.5);
  const Eigen::VectorXd step = bounded_step(normal, normal * wanted, model, unknowns);
  EXPECT_DOUBLE_EQ(step[0], -0.5);
  // The minimum of the quadratic with the first unknown held at its bound.
  const Eigen::Vector2d others = wanted.tail<2>() - normal.bottomRightCorner<2, 2>().inverse() *
                                                        normal.block<2, 1>(1, 0) *
                                                        (-0.5 - wanted[0]);
  EXPECT_NEAR(step[1], others[0], 1e-12);
  EXPECT_NEAR(step[2], others[1], 1e-12);
}

TEST(Fit, AnUnknownAtItsLongestStepDoesNotShortenTheOthers) {
  Model model;
  model.theta = Eigen::Vector2d(1, 1);
  std::vector<Unknown> unknowns{{Unknown::Kind::theta, 0}, {Unknown::Kind::theta, 1}};
  unknowns[0].longest_step = 0.5;
  unknowns[0].stops_alone = true;
  const Eigen::VectorXd step =
      bounded_step(Eigen::Matrix2d::Identity(), Eigen::Vector2d(-40, 3), model, unknowns);
  EXPECT_DOUBLE_EQ(step[0], -0.5);
  EXPECT_DOUBLE_EQ(step[1], 3);
}

TEST(Fit, FitsNoElementThatAddsEnergy) {
  Small small;
  small.truth.tail(small.table.elements())[0] *= -0.5;
  small.design = small.truth.cwiseAbs();
  const Plant plant = small.plant();
  const std::vector<RecordSegment> segments = small.segments({small.record({}, 1)});
  const Fitter fitter(plant, segments, {});
  const FitResult fit = fitter.fit(initial_model(plant), {}, {});
  ASSERT_TRUE(fit.good);
  EXPECT_GT(fit.model.theta.cwiseQuotient(plant.design).minCoeff(), 0.0199);
}

}  // namespace fit_test
}  // namespace framewatch::estimator
