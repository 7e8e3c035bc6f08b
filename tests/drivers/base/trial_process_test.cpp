#include "drivers/base/trial_process.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace trial_process_test {

TEST(TrialProcess, WhatEndsSurvivesAndChangesNothing) {
  int changed = 0;
  EXPECT_TRUE(survives_apart([&] { changed = 1; }, 60));
  EXPECT_EQ(changed, 0);
}

TEST(TrialProcess, ACrashIsTold) {
  EXPECT_FALSE(survives_apart([] { std::abort(); }, 60));
}

TEST(TrialProcess, WhatNeverEndsIsEnded) {
  const auto forever = [] {
    for (volatile bool on = true; on;) continue;
  };
  EXPECT_FALSE(survives_apart(forever, 1));
}

}  // namespace trial_process_test
}  // namespace framewatch::drivers
