// SPDX-License-Identifier: MIT
#include "estimator/gap/model_learner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace model_learner_test {

constexpr double kWindow_s = 5, kLearn_s = 60, kError = 0.01;

/// One stiffness that loses a tenth after change_at windows.
struct Learning {
  explicit Learning(int change_at, int windows, double learn_s = kLearn_s)
      : learner(2, 1, learn_s) {
    Random random(3);
    WindowEstimate e(2);
    e.status = WindowStatus::valid;
    for (int i = 0; i < windows && !learned; ++i) {
      e.start = from_microseconds(std::llround(1e6 * (kWindow_s + 0.01) * i));
      e.end = e.start + SensorClock::duration(std::llround(1e6 * kWindow_s));
      const double truth = i < change_at ? 1 : i == change_at ? 0.95 : 0.9;
      e.value = {truth + kError * random.normal(), 1};
      e.std_error = {kError, kError};
      e.reason = {Observability::observable, Observability::quiet};
      learned = learner.push(e);
      taken = i + 1;
    }
  }
  ModelLearner learner;
  bool learned = false;
  int taken = 0;
};

TEST(ModelLearner, TakesTheRequestedTimePlusTwoWindows) {
  const Learning l(1000, 100);
  ASSERT_TRUE(l.learned);
  EXPECT_EQ(l.taken, 14);
  EXPECT_NEAR(l.learner.learned()[0].value, 1, 3 * l.learner.learned()[0].std_error);
  EXPECT_TRUE(std::isnan(l.learner.learned()[1].value));
}

TEST(ModelLearner, LeavesOutWindowsAfterAChange) {
  for (const int change_at : {5, 8, 11, 12}) {
    const Learning l(change_at, 100);
    ASSERT_TRUE(l.learned) << change_at;
    EXPECT_NEAR(l.learner.learned()[0].value, 1, 3 * l.learner.learned()[0].std_error) << change_at;
  }
}

TEST(ModelLearner, RestartsAfterAnEarlyChange) {
  for (const int change_at : {1, 2}) {
    const Learning l(change_at, 100);
    ASSERT_TRUE(l.learned);
    EXPECT_NEAR(l.learner.learned()[0].value, 0.9, 3 * l.learner.learned()[0].std_error);
    EXPECT_GE(l.taken, change_at + 12);
  }
}

TEST(ModelLearner, IsBoundedAndExactOverADay) {
  const Learning l(1 << 30, 20000, 86400);
  ASSERT_TRUE(l.learned);
  EXPECT_NEAR(l.learner.learned()[0].value, 1, 4 * kError / std::sqrt(86400 / kWindow_s));
}

}  // namespace model_learner_test
}  // namespace framewatch::estimator
