// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/linear_operation.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/effect_of.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace linear_operation_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::effect_of;
using test::Small;

constexpr double kRounding = 1e-10;                   // of the largest entry
constexpr double kFrequencies[] = {3.0, 14.0, 40.0};  // rad/s

MatrixXcd operation_of(const Plant& plant, const ModelEffect& effect, double w) {
  return LinearOperation(plant, initial_model(plant), effect).at(w);
}

/// Returns the operation of an element with this stiffness and damping: k (-1/w^2) and c / jw along
/// it.
MatrixXcd element_operation(const Plant& plant, Index element, double stiffness, double damping,
                            double w) {
  return (-stiffness / (w * w) + damping / (kJ * w)) *
         MatrixXd(plant.building.act.col(element) * plant.building.sense.row(element));
}

void expect_same(const MatrixXcd& is, const MatrixXcd& expected, const std::string& what) {
  ASSERT_EQ(is.rows(), expected.rows());
  ASSERT_EQ(is.cols(), expected.cols());
  EXPECT_LT((is - expected).norm(), kRounding * std::max(expected.norm(), 1.0)) << what;
}

TEST(LinearOperation, AMassActsLikeAHeavierNode) {
  constexpr double kMass = 3000;
  const Small small;
  const Plant plant = small.plant();
  for (int crossing = 0; crossing < 4; ++crossing) {
    Small heavier;
    heavier.structure.node_mass[static_cast<std::size_t>(crossing)] += kMass;
    const MatrixXd more = heavier.plant().building.mass - plant.building.mass;
    for (const double w : kFrequencies)
      expect_same(
          operation_of(plant, effect_of(LawForm::mass, test::crossing_place(crossing), {kMass}), w),
          more.cast<Complex>(), "crossing " + std::to_string(crossing));
  }
}

TEST(LinearOperation, SpringsAndDampersToTheGroundActLikeAFrame) {
  constexpr double kStiffness = 4e5, kDamping = 9e3;
  const Plant plant = Small().plant();
  for (int f = 0; f < 4; ++f)
    for (const double w : kFrequencies) {
      const Index element = plant.table.frame_stiffness(1, f);
      expect_same(
          operation_of(plant, effect_of(LawForm::spring, test::pair_place(f), {kStiffness}), w),
          element_operation(plant, element, kStiffness, 0, w), "spring");
      expect_same(
          operation_of(plant, effect_of(LawForm::damper, test::pair_place(f), {kDamping}), w),
          element_operation(plant, element, 0, kDamping, w), "damper");
    }
}

TEST(LinearOperation, ASpringBetweenFloorsPullsBothAlike) {
  constexpr double kStiffness = 4e5, kW = 9;
  constexpr int kFrame = 2;
  const Plant plant = test::three_stories();
  const MatrixXcd d = operation_of(
      plant, effect_of(LawForm::spring, test::pair_place(kFrame, 3, 1), {kStiffness}), kW);
  const Index upper = plant.structure.dof(3, kFrame), lower = plant.structure.dof(1, kFrame);
  VectorXd along = VectorXd::Zero(plant.equations());
  along[upper] = 1;
  along[lower] = -1;
  MatrixXd expected = MatrixXd::Zero(plant.equations(), plant.axis_count());
  expected.leftCols(plant.equations()) =
      -kStiffness / (kW * kW) * MatrixXd(along * along.transpose());
  expect_same(d, expected.cast<Complex>(), "between floors 3 and 1");
}

TEST(LinearOperation, PanelsOfAFloorTakeTheirNewValues) {
  const Small small;
  const Plant plant = small.plant();
  const Index panel = plant.table.panel_stiffness(1, 0);
  const double g = plant.design[panel], c = plant.design[panel + plant.element_count()];
  for (const double w : kFrequencies) {
    expect_same(operation_of(plant, effect_of(LawForm::panels, test::floor_place(), {g, c}), w),
                MatrixXcd::Zero(4, 6), "as it is");
    expect_same(
        operation_of(plant, effect_of(LawForm::panels, test::floor_place(), {3 * g, 5 * c}), w),
        element_operation(plant, panel, 2 * g, 4 * c, w), "stiffer");
  }
}

/// A frame on a rotational spring is in series with it: k / (1 + k h^2 / kr).
TEST(LinearOperation, RockingAndBendingActInSeriesWithASingleFrame) {
  constexpr double kFlexibility = 2e-9;  // 1 / kr
  const test::SingleMass single;
  const Plant plant = single.plant();
  const double h = single.structure.story_height[0];
  const double kept = 1 / (1 + kFlexibility * single.stiffness * h * h);
  for (const LawForm form : {LawForm::rocking, LawForm::bending})
    for (const double w : kFrequencies) {
      const auto place = test::building_place(Direction::x);
      expect_same(operation_of(plant, effect_of(form, place, {kFlexibility}), w),
                  element_operation(plant, 0, single.stiffness * (kept - 1),
                                    single.damping * (kept * kept - 1), w),
                  "in series");
      expect_same(operation_of(plant, effect_of(form, place, {0}), w), MatrixXcd::Zero(1, 2),
                  "rigid");
    }
}

TEST(LinearOperation, BendingLeavesTheOtherDirectionAndRockingCouplesFrames) {
  constexpr double kFlexibility = 2e-9, kW = 11;
  const Plant plant = Small().plant();
  const auto of = [&](LawForm form, Direction direction) {
    return operation_of(plant, effect_of(form, test::building_place(direction), {kFlexibility}),
                        kW);
  };
  for (const LawForm form : {LawForm::rocking, LawForm::bending}) {
    EXPECT_TRUE(of(form, Direction::x).bottomRows(2).isZero(0));
    EXPECT_TRUE(of(form, Direction::y).topRows(2).isZero(0));
    EXPECT_GT(of(form, Direction::x).topRows(2).norm(), 0);
  }
  EXPECT_LT(std::abs(of(LawForm::bending, Direction::x)(0, 1)), 1e-6);
  EXPECT_GT(std::abs(of(LawForm::rocking, Direction::x)(0, 1)), 1);
}

TEST(LinearOperation, AResonatorIsolatesAboveItsFrequency) {
  constexpr double kHz = 2, kDamping = 0.07, kMass = 900;
  const ModelEffect resonator =
      effect_of(LawForm::resonator, test::node_place(1), {kMass, kHz, kDamping});
  const double wr = 2 * M_PI * kHz;
  EXPECT_NEAR(std::abs(transmissibility(resonator, 1e-6) - 1.0), 0, 1e-9);
  EXPECT_NEAR(std::abs(transmissibility(resonator, wr)),
              std::sqrt(1 + 4 * kDamping * kDamping) / (2 * kDamping), 1e-9);
  EXPECT_LT(transmissibility(resonator, wr).imag(), 0);  // it lags
  EXPECT_LT(std::abs(transmissibility(resonator, 1e4)), 1e-3);
  const Plant plant = Small().plant();
  for (const double w : kFrequencies) {
    MatrixXcd expected = MatrixXcd::Zero(4, 6);
    expected(1, 1) = kMass * transmissibility(resonator, w);
    expect_same(operation_of(plant, resonator, w), expected, "resonator");
  }
}

TEST(LinearOperation, ForcesFromOutsideAndReadingsAddNothing) {
  const Plant plant = Small().plant();
  for (const LawForm form : {LawForm::harmonic, LawForm::broadband, LawForm::misaligned,
                             LawForm::swapped, LawForm::clipped}) {
    EffectPlace place = test::node_place(1);
    place.channel = 0;
    place.with_channel = 1;
    expect_same(operation_of(plant, effect_of(form, place, {2.0}), 10), MatrixXcd::Zero(4, 6),
                std::to_string(static_cast<int>(form)));
  }
}

TEST(LinearOperation, IsAddedToExistingTerms) {
  constexpr double kW = 10;
  const Plant plant = Small().plant();
  const ModelEffect mass = effect_of(LawForm::mass, test::crossing_place(2), {500});
  const LinearOperation operation(plant, initial_model(plant), mass);
  MatrixXcd sum = MatrixXcd::Constant(4, 6, Complex(1, 2));
  operation.add_to(kW, sum);
  operation.add_to(kW, sum);
  expect_same(sum, MatrixXcd::Constant(4, 6, Complex(1, 2)) + 2 * operation.at(kW), "twice");
}

}  // namespace linear_operation_test
}  // namespace framewatch::estimator
