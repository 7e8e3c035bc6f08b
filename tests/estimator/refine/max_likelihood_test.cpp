// SPDX-License-Identifier: MIT
#include "estimator/refine/max_likelihood.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "estimator/numeric/quantile.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/noisy_stretch.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace max_likelihood_test {

constexpr double kRate_hz = 100;

struct Building {
  Structure structure;
  Eigen::VectorXd truth;
};

Building table1() {
  return {test::table1(), test::table1_theta()};
}

/// Two eccentric stories of one bay, 20 parameters.
Building two_stories(FloorModel floor = FloorModel::flexible) {
  Structure s = test::table1();
  s.stories = 2;
  s.story_height.resize(2);
  s.node_mass.resize(static_cast<std::size_t>(s.nodes()));
  s.floor = floor;
  const ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  const double frames[] = {3.5e6, 2e6, 2e6, 3e6, 3e6, 2.5e6, 3e6, 2e6};
  for (int story = 1; story <= 2; ++story)
    for (int f = 0; f < 4; ++f)
      theta[table.frame_stiffness(story, f)] = frames[4 * (story - 1) + f];
  for (int story = 1; story <= 2; ++story)
    for (int p = 0; p < s.panels(); ++p) theta[table.panel_stiffness(story, p)] = 2.5e5;
  return {s, with_proportional_damping(s, table, theta, 0.02)};
}

Refinement refine(const Building& b, const test::ExactRecord& segment,
                  const Eigen::MatrixXd& measured, bool prior, std::uint64_t seed) {
  const Eigen::VectorXd design =
      daemon::perturbed_design(ParameterTable(b.structure), b.truth, 0.1, 0.3, seed);
  RefineOptions options;
  options.prior = prior;
  return refine_max_likelihood(b.structure, segment.axes, kRate_hz, measured, design, design,
                               options);
}

TEST(MaxLikelihood, ExactMotionGivesTheTruth) {
  constexpr double kLimit = 1e-4;  // panel damping; frame stiffness is below 1e-5
  const Building b = table1();
  const auto segment = test::exact_stretch(b.structure, b.truth, test::oblique_motion(1), 1e-6);
  const Refinement r = refine(b, segment, segment.accel_abs, false, 3);
  ASSERT_EQ(r.status, RefineStatus::converged);
  const Eigen::VectorXd error = (r.theta.cwiseQuotient(b.truth).array() - 1).abs();
  EXPECT_LT(error.maxCoeff(), kLimit);
  EXPECT_LT(error.head(20).maxCoeff(), 0.1 * kLimit);
}

TEST(MaxLikelihood, ScatterMatchesTheBound) {
  // GIVEN one motion and 60 draws of 2 % noise: a scatter is known to 9 % of itself
  constexpr int kDraws = 60;
  constexpr double kMin = 0.75, kMax = 1.4;  // of each parameter
  const Building b = two_stories();
  const auto segment = test::exact_stretch(b.structure, b.truth, test::oblique_motion(2), 0.02);
  const CramerRaoBound bound =
      cramer_rao_bound(b.structure, segment.axes, b.truth, kRate_hz, segment.accel_abs);
  ASSERT_EQ(bound.status, SegmentStatus::good);
  // WHEN each draw is refined without the prior
  Eigen::VectorXd square = Eigen::VectorXd::Zero(b.truth.size()), stated = square, mean = square;
  int covered = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto seed = static_cast<std::uint64_t>(1000 + draw);
    const Refinement r = refine(b, segment, test::with_noise(segment, seed), false, seed);
    ASSERT_EQ(r.status, RefineStatus::converged);
    EXPECT_NEAR(r.misfit_ratio, 1, 0.25);
    const Eigen::VectorXd error = (r.theta - b.truth).cwiseQuotient(bound.std_error);
    square += error.cwiseAbs2() / kDraws;
    mean += error / kDraws;
    stated += r.std_error.cwiseQuotient(bound.std_error) / kDraws;
    covered += static_cast<int>(
        ((r.theta - b.truth).cwiseAbs().array() < 1.96 * r.std_error.array()).count());
  }
  // THEN scatter and stated errors equal the bound, and the 95 % intervals hold
  for (Eigen::Index p = 0; p < b.truth.size(); ++p) {
    EXPECT_GT(std::sqrt(square[p]), kMin) << p;
    EXPECT_LT(std::sqrt(square[p]), kMax) << p;
    EXPECT_LT(std::abs(mean[p]), 0.6) << p;
    EXPECT_NEAR(stated[p], 1, 0.25) << p;
  }
  const double coverage = covered / (kDraws * static_cast<double>(b.truth.size()));
  EXPECT_GT(coverage, 0.91);
  EXPECT_LT(coverage, 0.98);
}

TEST(MaxLikelihood, TableOneAtOnePercentReachesTheBound) {
  constexpr double kMedianK = 0.00065;  // method.md, Table A
  constexpr int kMotions = 6;
  const Building b = table1();
  std::vector<double> error, bound;
  for (int seed = 1; seed <= kMotions; ++seed) {
    const auto s = static_cast<std::uint64_t>(seed);
    const auto segment = test::exact_stretch(b.structure, b.truth, test::oblique_motion(s), 0.01);
    const Refinement r = refine(b, segment, test::with_noise(segment, 77 * s), true, s);
    ASSERT_EQ(r.status, RefineStatus::converged);
    const CramerRaoBound least =
        cramer_rao_bound(b.structure, segment.axes, b.truth, kRate_hz, segment.accel_abs);
    for (Eigen::Index p = 0; p < 20; ++p) {
      error.push_back(std::abs(r.theta[p] / b.truth[p] - 1));
      bound.push_back(0.674 * least.std_error[p] / b.truth[p]);
    }
  }
  const double middle = upper_median(error), least_middle = upper_median(bound);
  EXPECT_LT(middle, kMedianK);
  EXPECT_LT(middle, 1.25 * least_middle);
  EXPECT_GT(middle, 0.75 * least_middle);
}

TEST(MaxLikelihood, RigidFloorsMayLackSensors) {
  const Building b = two_stories(FloorModel::rigid);
  auto segment = test::exact_stretch(b.structure, b.truth, test::oblique_motion(2), 0.01);
  Eigen::MatrixXd measured = test::with_noise(segment, 5);
  const Refinement all = refine(b, segment, measured, false, 5);
  ASSERT_EQ(all.status, RefineStatus::converged);
  // WHEN a fourth sensor of a floor is removed
  segment.axes.erase(segment.axes.begin() + 3);
  Eigen::MatrixXd fewer(measured.rows(), measured.cols() - 1);
  fewer << measured.leftCols(3), measured.rightCols(measured.cols() - 4);
  const Refinement some = refine(b, segment, fewer, false, 5);
  // THEN the other three suffice, with larger errors
  ASSERT_EQ(some.status, RefineStatus::converged);
  for (Eigen::Index p = 0; p < 8; ++p) {
    EXPECT_LT(std::abs(all.theta[p] - b.truth[p]), 4 * all.std_error[p]) << p;
    EXPECT_LT(std::abs(some.theta[p] - b.truth[p]), 4 * some.std_error[p]) << p;
  }
  EXPECT_GT(some.bound.head(8).sum(), all.bound.head(8).sum());
}

TEST(MaxLikelihood, EstimatesUnknownNoiseFromTheMisfit) {
  const Building b = two_stories();
  auto segment = test::exact_stretch(b.structure, b.truth, test::oblique_motion(2), 0.02);
  const Eigen::MatrixXd measured = test::with_noise(segment, 9);
  for (SensorAxis& axis : segment.axes) axis.noise_density = 0;
  const Refinement r = refine(b, segment, measured, true, 9);
  ASSERT_EQ(r.status, RefineStatus::converged);
  EXPECT_GT(r.misfit_ratio, 100);  // the default noise density 1e-4 is far below the noise
  for (Eigen::Index p = 0; p < 8; ++p) {
    EXPECT_LT(std::abs(r.theta[p] - b.truth[p]), 4 * r.std_error[p]) << p;
    EXPECT_LT(r.std_error[p], 0.02 * b.truth[p]) << p;
  }
}

TEST(MaxLikelihood, PureNoiseIsQuiet) {
  const Building b = two_stories();
  auto segment = test::exact_stretch(b.structure, b.truth, test::oblique_motion(2), 0.02);
  segment.accel_abs.setZero();
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_EQ(refine(b, segment, test::with_noise(segment, seed), true, seed).status,
              RefineStatus::quiet)
        << seed;
  EXPECT_EQ(refine(b, segment, segment.accel_abs, true, 4).status, RefineStatus::quiet);
}

TEST(MaxLikelihood, RefusesAnInvalidStretch) {
  const Building b = two_stories();
  const auto good = test::exact_stretch(b.structure, b.truth, test::oblique_motion(2), 0.02);
  auto bad = good;
  bad.accel_abs(3, 2) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refine(b, bad, bad.accel_abs, true, 1).status, RefineStatus::bad_samples);
  EXPECT_EQ(refine(b, good, good.accel_abs.topRows(40), true, 1).status, RefineStatus::too_short);
  EXPECT_EQ(refine(b, good, good.accel_abs.leftCols(4), true, 1).status, RefineStatus::bad_input);
  const Refinement r = refine_max_likelihood(b.structure, good.axes, kRate_hz, good.accel_abs,
                                             Eigen::VectorXd::Ones(3), b.truth);
  EXPECT_EQ(r.status, RefineStatus::bad_input);
  EXPECT_FALSE(r.has_values());
}

}  // namespace max_likelihood_test
}  // namespace framewatch::estimator
