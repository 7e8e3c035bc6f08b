// SPDX-License-Identifier: MIT
#include "drivers/files/caught.h"

#include <unistd.h>

#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace caught_test {

TEST(TryApart, ReportsSurvivalWithoutSideEffects) {
  int changed = 0;
  EXPECT_EQ(try_apart([&] { changed = 1; }, 60), AttemptEnd::survived);
  EXPECT_EQ(changed, 0);
}

TEST(TryApart, ReportsACrash) {
  EXPECT_EQ(try_apart([] { std::abort(); }, 60), AttemptEnd::crashed);
}

TEST(TryApart, EndsATaskThatNeverReturns) {
  const auto forever = [] {
    for (volatile bool on = true; on;) continue;
  };
  EXPECT_EQ(try_apart(forever, 1), AttemptEnd::too_long);
  EXPECT_EQ(try_apart([] { ::pause(); }, 3), AttemptEnd::too_long);
}

TEST(TryApart, ContainsExceptions) {
  EXPECT_EQ(try_apart([] { throw std::bad_alloc(); }, 60), AttemptEnd::survived);
}

}  // namespace caught_test
}  // namespace framewatch::drivers
