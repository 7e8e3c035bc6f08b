#include "drivers/files/trial_process.h"

#include <unistd.h>

#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace trial_process_test {

TEST(TrialProcess, WhatEndsSurvivesAndChangesNothing) {
  int changed = 0;
  EXPECT_EQ(try_apart([&] { changed = 1; }, 60), Trial::survived);
  EXPECT_EQ(changed, 0);
}

TEST(TrialProcess, ACrashIsTold) {
  EXPECT_EQ(try_apart([] { std::abort(); }, 60), Trial::crashed);
}

TEST(TrialProcess, WhatNeverEndsIsEnded) {
  const auto forever = [] {
    for (volatile bool on = true; on;) continue;
  };
  EXPECT_EQ(try_apart(forever, 1), Trial::too_long);
  EXPECT_EQ(try_apart([] { ::pause(); }, 3), Trial::too_long);
}

TEST(TrialProcess, WhatIsThrownStaysThere) {
  EXPECT_EQ(try_apart([] { throw std::bad_alloc(); }, 60), Trial::survived);
}

}  // namespace trial_process_test
}  // namespace framewatch::drivers
