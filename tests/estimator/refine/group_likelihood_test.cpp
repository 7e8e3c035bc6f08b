// SPDX-License-Identifier: MIT
#include "estimator/refine/group_likelihood.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/tools/lab/few_sensors.h"
#include "estimator/refine/max_likelihood.h"
#include "estimator/structure/group_design.h"

namespace framewatch::estimator {
namespace group_likelihood_test {

using daemon::tall_record;
using daemon::TallRecord;
using daemon::TallTrial;

/// A short building for a quick test: sensors on the base and floors 2, 4 and 6 of six.
TallTrial six_stories() {
  TallTrial trial;
  trial.stories = 6;
  trial.floors = {2, 4, 6};
  trial.duration_s = 30;
  return trial;
}

Eigen::VectorXd design_of(const PipelineConfig& c) {
  return group_parameters(c.structure, c.parameters(), {c.design, c.bending_nmprad});
}

Refinement refine(const TallRecord& record, Eigen::Index first, Eigen::Index rows,
                  bool prior = false) {
  const Eigen::VectorXd design = design_of(record.config);
  RefineOptions options;
  options.prior = prior;
  return refine_max_likelihood(record.config, record.accel.middleRows(first, rows), design, design,
                               options);
}

Eigen::VectorXd relative_error(const TallRecord& record, const Refinement& r) {
  return (r.theta.cwiseQuotient(record.truth).array() - 1).abs();
}

TEST(GroupLikelihood, GradientMatchesTheMisfit) {
  constexpr double kStep = 1e-4, kLimit = 1e-5;
  TallTrial trial = six_stories();
  trial.believed_bending_nmprad = 5e11;
  trial.bending_nmprad = 5e11;
  const TallRecord record = tall_record(trial);
  const MeasuredGroups groups = measured_groups(record.config);
  const Spectrum spectrum = spectrum_of(record.accel.middleRows(1000, 501), groups.delay,
                                        record.config.options.rate_hz, {0.5, 10});
  GroupLikelihood likelihood(groups, spectrum, EndTerms::sampled);
  const Eigen::VectorXd theta = 1.05 * record.truth;
  const auto point = likelihood.at(theta);
  ASSERT_TRUE(point);
  for (Eigen::Index p = 0; p < theta.size(); ++p) {
    Eigen::VectorXd above = theta, below = theta;
    above[p] *= 1 + kStep;
    below[p] *= 1 - kStep;
    const double slope = (*likelihood.misfit(above) - *likelihood.misfit(below)) / (2 * kStep);
    EXPECT_NEAR(theta[p] * point->gradient[p], slope,
                kLimit * std::abs(slope) + 1e-6 * point->misfit)
        << p;
  }
}

TEST(GroupLikelihood, ExactMotionGivesTheTruth) {
  constexpr double kStiffness = 2e-4, kDamping = 3e-3;  // sampled motion has unknown ends
  TallTrial trial = six_stories();
  trial.noise_ratio = 0;
  const TallRecord record = tall_record(trial);
  const Refinement r = refine(record, 1000, 501);
  ASSERT_EQ(r.status, RefineStatus::converged);
  const Eigen::VectorXd error = relative_error(record, r);
  EXPECT_LT(error.head(3).maxCoeff(), kStiffness);
  EXPECT_LT(error.tail(3).maxCoeff(), kDamping);
}

TEST(GroupLikelihood, StatesItsErrorsRightly) {
  constexpr int kDraws = 12;
  constexpr double kMin = 0.6, kMax = 1.5;  // of 72 errors over their standard error
  double stiffness = 0, damping = 0;
  for (int seed = 1; seed <= kDraws; ++seed) {
    TallTrial trial = six_stories();
    trial.seed = static_cast<std::uint64_t>(seed);
    const TallRecord record = tall_record(trial);
    const Refinement r = refine(record, 1000, 501);
    ASSERT_EQ(r.status, RefineStatus::converged);
    EXPECT_NEAR(r.misfit_ratio, 1, 0.25);
    const Eigen::VectorXd z = (r.theta - record.truth).cwiseQuotient(r.std_error);
    stiffness += z.head(3).squaredNorm() / (3 * kDraws);
    damping += z.tail(3).squaredNorm() / (3 * kDraws);
    EXPECT_TRUE((r.bound.array() < 1.5 * r.std_error.array()).all());
  }
  EXPECT_GT(std::sqrt(stiffness), kMin);
  EXPECT_LT(std::sqrt(stiffness), kMax);
  EXPECT_GT(std::sqrt(damping), kMin);
  EXPECT_LT(std::sqrt(damping), kMax);
}

TEST(GroupLikelihood, ATallBuildingIsWithinTheErrorsOfItsTable) {
  const TallRecord record = tall_record({});
  const Refinement r = refine(record, 3000, 501);
  ASSERT_EQ(r.status, RefineStatus::converged);
  EXPECT_LT(relative_error(record, r).head(4).maxCoeff(), 0.002);
  EXPECT_LT(relative_error(record, r).tail(4).maxCoeff(), 0.02);
}

TEST(GroupLikelihood, FindsTheBending) {
  TallTrial trial = six_stories();
  trial.bending_nmprad = 5e11;
  trial.believed_bending_nmprad = 7e11;
  const TallRecord record = tall_record(trial);
  const Refinement r = refine(record, 1000, 1501);
  ASSERT_EQ(r.status, RefineStatus::converged);
  const int krx = record.config.parameters().find("krx").value();
  EXPECT_LT(relative_error(record, r)[krx], 0.05);
}

TEST(GroupLikelihood, ReportsWhyItCannotFit) {
  const TallRecord record = tall_record(six_stories());
  EXPECT_EQ(refine(record, 1000, 10).status, RefineStatus::too_short);
  TallRecord holed = record;
  holed.accel(1100, 1) = std::nan("");
  EXPECT_EQ(refine(holed, 1000, 501).status, RefineStatus::bad_samples);
  TallRecord fewer = record;
  fewer.accel.conservativeResize(Eigen::NoChange, 2);
  EXPECT_EQ(refine(fewer, 1000, 501).status, RefineStatus::bad_input);
  TallRecord still = record;
  still.accel *= 1e-6;
  EXPECT_EQ(refine(still, 1000, 501, true).status, RefineStatus::quiet);
}

}  // namespace group_likelihood_test
}  // namespace framewatch::estimator
