// SPDX-License-Identifier: MIT
// Distance of the streaming estimator from the Cramer-Rao bound; framewatch reproduce prints the
// whole table for twenty motions (docs/accuracy.md).

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_study.h"

namespace framewatch::estimator {
namespace streaming_bound_test {

constexpr int kMotions = 3;
constexpr double kMax = 2.0;  // for three motions; 1.6 holds over twenty
constexpr double kMin = 0.7;  // a lower value means that the bound is wrong

TEST(StreamingBound, TableOneStiffnessIsWithinTwiceTheBound) {
  const daemon::AccuracyRow row =
      daemon::study_accuracy(daemon::accuracy_cases().front(), kMotions, daemon::Workers(1));
  const double ratio = row.of(daemon::Method::matched, 0).quantile(0.5) / row.least_median(0);
  EXPECT_LT(ratio, kMax);
  EXPECT_GT(ratio, kMin);
}

}  // namespace streaming_bound_test
}  // namespace framewatch::estimator
