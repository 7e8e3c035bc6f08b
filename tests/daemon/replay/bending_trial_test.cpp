#include "daemon/replay/bending_trial.h"

#include <cmath>

#include <gtest/gtest.h>

#include "daemon/lab/few_sensors.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {
namespace bending_trial_test {

constexpr double kBending_nmprad = 3e12, kWithin = 0.1;

/// Twenty stories with five instrumented levels, refined without bending and tried with it.
std::optional<BendingTrial> tried(double bending_nmprad, double believed_nmprad = 0) {
  TallTrial trial;
  trial.duration_s = 30;
  trial.bending_nmprad = bending_nmprad;
  trial.believed_bending_nmprad = believed_nmprad;
  TallRecord record = tall_record(trial);
  const estimator::PipelineConfig& c = record.config;
  const Eigen::VectorXd design =
      group_parameters(c.structure, c.parameters(), {c.design, c.bending_nmprad});
  const Eigen::MatrixXd accel = record.accel.bottomRows(record.accel.rows() / 2);
  estimator::RefineOptions options;
  options.prior = false;
  const estimator::Refinement rigid =
      refine_max_likelihood(c, accel, design, design, options);
  return try_bending(c, accel, rigid, options);
}

TEST(BendingTrial, SaysThatFramesBendAndHowMuch) {
  const auto bends = tried(kBending_nmprad);
  ASSERT_TRUE(bends);
  EXPECT_TRUE(bends->needed);
  EXPECT_NEAR(bends->stiffness_nmprad[0] / kBending_nmprad, 1, kWithin);
  EXPECT_TRUE(std::isnan(bends->stiffness_nmprad[1]));
  EXPECT_LT(bends->misfit_ratio, 2);
}

TEST(BendingTrial, OfFramesThatDoNotSaysNoNeed) {
  const auto shears = tried(0);
  if (shears) EXPECT_FALSE(shears->needed);
}

TEST(BendingTrial, IsNoneWhereTheDesignBends) {
  EXPECT_FALSE(tried(kBending_nmprad, kBending_nmprad));
}

}  // namespace bending_trial_test
}  // namespace framewatch::daemon
