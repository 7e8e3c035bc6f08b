// SPDX-License-Identifier: MIT
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/guest/inner/guest.h"

namespace framewatch::test {
namespace {

using Clock = std::chrono::steady_clock;

double tower_seconds() {
  const char* set = std::getenv("CAN_TEST_SECONDS");
  return set != nullptr ? std::atof(set) : 60;
}

TEST(Tower, EighteenNodesLoseNothingAndGiveTheEstimatesOfLcm) {
  const double seconds = tower_seconds();
  const Vcan vcan("vcan0");
  const daemon::Config config = example_on("tower", "vcan0");
  LiveBuses live(config);
  Process nodes({FRAMEWATCH_PROGRAM, "simulate", kTowerScenario, "--can", "vcan0", "--seconds",
                 fmt::format("{}", seconds), "--quiet"});
  live.run([&] { return nodes.ended(); });
  const auto instants = static_cast<std::int64_t>(std::floor(seconds * 100)) + 1;
  for (std::size_t n = 0; n < config.can.nodes.size(); ++n) {
    const drivers::CanNodeCounters c = live.estimation.can().node(n);
    EXPECT_EQ(c.received, instants) << config.can.nodes[n].name;
    EXPECT_EQ(c.lost + c.late + c.duplicates + c.unplaced, 0)
        << fmt::format("{}: {} lost, {} late, {} duplicate, {} without place",
                       config.can.nodes[n].name, c.lost, c.late, c.duplicates, c.unplaced);
  }
  EXPECT_EQ(live.source.dropped(), 0);
  const std::vector<estimator::WindowEstimate> expected =
      estimates_over_lcm(kTowerScenario, seconds);
  std::int64_t observable = 0;
  for (const estimator::WindowEstimate& e : expected)
    observable +=
        std::count(e.reason.begin(), e.reason.end(), estimator::Observability::observable);
  EXPECT_GT(observable, 0);
  EXPECT_EQ(live.estimates.size(), expected.size());
  EXPECT_EQ(different(live.estimates, expected), 0u);
  fmt::print("{} nodes x {} instants, 0 lost; {} windows, {} values, all the same\n",
             config.can.nodes.size(), instants, expected.size(), observable);
}

void step_host_clock(int seconds) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  now.tv_sec += seconds;
  EXPECT_EQ(::clock_settime(CLOCK_REALTIME, &now), 0);
}

TEST(Tower, AStepOfTheHostsClockChangesNoEstimate) {
  if (std::getenv("IN_CAN_GUEST") == nullptr) GTEST_SKIP() << "sets the clock: only in a guest";
  constexpr double kSeconds = 10;
  const Vcan vcan("vcan0");
  const daemon::Config config = example_on("tower", "vcan0");
  LiveBuses live(config);
  const auto start = Clock::now();
  Process nodes({FRAMEWATCH_PROGRAM, "simulate", kTowerScenario, "--can", "vcan0", "--seconds",
                 fmt::format("{}", kSeconds), "--quiet"});
  int steps = 0;
  live.run([&] {
    const std::chrono::duration<double> passed = Clock::now() - start;
    if (steps == 0 && passed.count() > 5) step_host_clock(1), ++steps;
    if (steps == 1 && passed.count() > 7) step_host_clock(-1), ++steps;
    return nodes.ended();
  });
  EXPECT_EQ(live.source.clock_steps(), 2);
  const std::vector<estimator::WindowEstimate> expected =
      estimates_over_lcm(kTowerScenario, kSeconds);
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(live.estimates.size(), expected.size());
  EXPECT_EQ(different(live.estimates, expected), 0u);
}

TEST(Demo, TheDemoFindsItsStiffnessesOverCan) {
  const Vcan vcan("vcan0");
  Process demo({FRAMEWATCH_PROGRAM, "demo", "--can", "vcan0", "--seconds", "12", "--quiet"});
  while (!demo.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

}  // namespace
}  // namespace framewatch::test
