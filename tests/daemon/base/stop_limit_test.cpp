// SPDX-License-Identifier: MIT
#include "daemon/base/stop_limit.h"

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace stop_limit_test {

using namespace std::chrono_literals;

// Limits.
constexpr std::chrono::milliseconds kLimit = 300ms, kFarBeyond = 2s;

TEST(StopLimit, GivesUpAndSaysWhatIsLeft) {
  std::atomic<bool> requested = false, gave_up = false;
  testing::internal::CaptureStderr();
  {
    StopLimit limit([&] { return requested.load(); }, kLimit, [&] { gave_up = true; });
    limit.left({"the state", "the history"});
    limit.done("the state");
    std::this_thread::sleep_for(2 * kLimit);
    EXPECT_FALSE(gave_up) << "before a stop was requested";
    requested = true;
    const auto until = std::chrono::steady_clock::now() + kFarBeyond;
    while (!gave_up && std::chrono::steady_clock::now() < until) std::this_thread::sleep_for(10ms);
  }
  EXPECT_TRUE(gave_up);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("gave up 0.3 s after the stop was requested. Not done: the history"),
            std::string::npos)
      << said;
}

TEST(StopLimit, LetsAStopInTimeEnd) {
  std::atomic<bool> gave_up = false;
  {
    StopLimit limit([] { return true; }, kFarBeyond, [&] { gave_up = true; });
    std::this_thread::sleep_for(kLimit);
  }
  std::this_thread::sleep_for(kLimit);
  EXPECT_FALSE(gave_up);
}

TEST(StopLimitDeathTest, EndsTheProcessWithAFailure) {
  EXPECT_EXIT(
      {
        const StopLimit limit([] { return true; }, kLimit);
        std::this_thread::sleep_for(kFarBeyond);
      },
      testing::ExitedWithCode(1), "Not done: the work under way");
}

}  // namespace stop_limit_test
}  // namespace framewatch::daemon
