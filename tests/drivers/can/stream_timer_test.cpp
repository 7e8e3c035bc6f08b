// SPDX-License-Identifier: MIT
#include "drivers/can/stream_timer.h"

#include <cmath>
#include <map>
#include <memory>
#include <random>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace stream_timer_test {

constexpr double kAlignment_us = 100;  ///< the promise: 0.1 ms after settling
constexpr double kSettle_s = 5;
constexpr double kPeriod_us = 10000;
constexpr double kEpoch_us = 1.7e15;

/// A node with a clock error of `ppm`, on a bus where a frame takes 0.27 ms and waits up to
/// `jitter_us` more. Knows the true sampling instants.
struct Node {
  double ppm, jitter_us, phase_us;
  StreamTimer timer;
  std::map<std::int64_t, double> told;  ///< by number
  std::vector<double> errors_us;  ///< of those after settling: told minus true, and frame time
  std::mt19937 random{3};

  Node(double ppm_, double jitter, double phase, const StreamTimer::Settings& settings,
       HostClockSteps& steps)
      : ppm(ppm_), jitter_us(jitter), phase_us(phase), timer(settings, steps) {
    timer.on_delivery([this](const TimedValues& v, double time_us) { told[v.number] = time_us; });
  }
  double true_us(std::int64_t k) const {
    return kEpoch_us + phase_us + kPeriod_us * static_cast<double>(k) * (1 + 1e-6 * ppm);
  }
  double stamp_us(std::int64_t k) {
    const double share = std::uniform_real_distribution<double>(0, 1)(random);
    return std::floor(true_us(k) + 270 + jitter_us * share);
  }
};

StreamTimer::Settings counter16() {
  return {CanTiming::counter, kPeriod_us, kPeriod_us, 65536};
}

double worst_after_settling(const Node& node, std::int64_t from) {
  double worst = 0;
  for (const auto& [number, time_us] : node.told)
    if (number >= from) worst = std::max(worst, std::abs(time_us - 270 - node.true_us(number)));
  return worst;
}

TEST(StreamTimer, FollowsDriftToATenthOfAMillisecond) {
  for (const double ppm : {-100.0, 0.0, 100.0})
    for (const double jitter_us : {200.0, 2000.0}) {
      HostClockSteps steps;
      Node node(ppm, jitter_us, 1234, counter16(), steps);
      constexpr std::int64_t kFrames = 90000;  // the counter wraps
      for (std::int64_t k = 0; k < kFrames; ++k)
        node.timer.open_sample(static_cast<double>(k % 65536), node.stamp_us(k), {0, 0, 0, {}});
      node.timer.finish();
      EXPECT_EQ(node.told.size(), static_cast<std::size_t>(kFrames));
      const double worst =
          worst_after_settling(node, static_cast<std::int64_t>(kSettle_s * 1e6 / kPeriod_us));
      RecordProperty("worst_us", static_cast<int>(worst));
      EXPECT_LT(worst, kAlignment_us) << ppm << " ppm, jitter " << jitter_us;
      EXPECT_EQ(node.timer.restarts(), 0);
    }
}

TEST(StreamTimer, FollowsAClockThatWrapsAndCountsInItsOwnUnit) {
  HostClockSteps steps;
  // 24 bits of 100 us: wraps after 28 minutes; 100 ppm fast.
  Node node(-100, 500, 0, {CanTiming::clock, kPeriod_us, 100, std::ldexp(1.0, 24)}, steps);
  for (std::int64_t k = 0; k < 200000; ++k) {
    const double ticks = std::fmod(1.6e7 + 100.0 * static_cast<double>(k), std::ldexp(1.0, 24));
    node.timer.open_sample(ticks, node.stamp_us(k), {0, 0, 0, {}});
  }
  node.timer.finish();
  EXPECT_EQ(node.told.size(), 200000u);
  EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
}

TEST(StreamTimer, LossesDuplicatesAndReorderingShiftNoSample) {
  HostClockSteps steps;
  Node node(50, 1000, 0, counter16(), steps);
  std::mt19937 random(17);
  std::int64_t held = -1;
  double held_us = 0;
  std::size_t sent = 0;
  for (std::int64_t k = 0; k < 20000; ++k) {
    const double stamp = node.stamp_us(k);
    if (random() % 20 == 0) continue;
    if (held < 0 && random() % 50 == 0) {  // held back until after the next frame
      held = k;
      held_us = stamp;
      continue;
    }
    node.timer.open_sample(static_cast<double>(k % 65536), stamp, {0, 0, 0, {}});
    ++sent;
    if (random() % 50 == 0)
      node.timer.open_sample(static_cast<double>(k % 65536), stamp + 300, {0, 0, 0, {}});
    if (held < 0) continue;
    node.timer.open_sample(static_cast<double>(held % 65536), std::max(held_us, stamp + 100),
                           {0, 0, 0, {}});
    ++sent;
    held = -1;
  }
  node.timer.finish();
  EXPECT_EQ(node.told.size(), sent);
  EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
}

TEST(StreamTimer, AnOutageLeavesAGapOfItsLength) {
  HostClockSteps steps;
  Node node(100, 500, 0, counter16(), steps);
  for (std::int64_t k = 0; k < 12000; ++k)
    if (k < 3000 || k >= 6000)
      node.timer.open_sample(static_cast<double>(k % 65536), node.stamp_us(k), {0, 0, 0, {}});
  node.timer.finish();
  EXPECT_EQ(node.told.size(), 9000u);
  EXPECT_EQ(node.told.upper_bound(2999)->first, 6000);
  EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
}

TEST(StreamTimer, ARebootOfOneNodeLeavesOthersAlone) {
  HostClockSteps steps;
  Node steady(0, 500, 0, counter16(), steps), reboots(0, 500, 2500, counter16(), steps);
  for (std::int64_t k = 0; k < 6000; ++k) {
    steady.timer.open_sample(static_cast<double>(k), steady.stamp_us(k), {0, 0, 0, {}});
    if (k >= 2000 && k < 2137) continue;
    const std::int64_t counter = k < 2000 ? 40000 + k : k - 2137;
    reboots.timer.open_sample(static_cast<double>(counter), reboots.stamp_us(k), {0, 0, 0, {}});
  }
  steady.timer.finish();
  reboots.timer.finish();
  EXPECT_EQ(reboots.timer.restarts(), 1);
  EXPECT_EQ(steady.timer.restarts(), 0);
  EXPECT_EQ(steps.count(), 0);
  EXPECT_LT(worst_after_settling(steady, 500), kAlignment_us);
  ASSERT_EQ(reboots.told.size(), 6000u - 137);
  std::int64_t k = 0;
  double worst = 0;
  for (const auto& [number, time_us] : reboots.told) {
    EXPECT_EQ(number, k);  // numbers continue
    const std::int64_t sample = k < 2000 ? k : k + 137;
    if (k > 500 && (k < 2000 || k > 2500))
      worst = std::max(worst, std::abs(time_us - 270 - reboots.true_us(sample)));
    ++k;
  }
  EXPECT_LT(worst, kAlignment_us);
}

TEST(StreamTimer, AStepOfTheHostsClockMovesNoStamp) {
  for (const double step_us : {1e6, -1e6}) {
    HostClockSteps steps;
    std::vector<std::unique_ptr<Node>> nodes;
    for (int n = 0; n < 6; ++n)
      nodes.push_back(
          std::make_unique<Node>(n % 2 ? 100 : -100, 1000, 700.0 * n, counter16(), steps));
    constexpr std::int64_t kStep = 4000, kFrames = 12000;
    for (std::int64_t k = 0; k < kFrames; ++k)
      for (const auto& node : nodes) {
        const double stamp = node->stamp_us(k) + (k >= kStep ? step_us : 0);
        node->timer.open_sample(static_cast<double>(k % 65536), steps.continuous(stamp),
                                {0, 0, 0, {}});
      }
    EXPECT_EQ(steps.count(), 1);
    // All nodes see the same step, so they stay consistent with each other.
    for (std::int64_t k = kStep + 500; k < kFrames; ++k) {
      double least = 1e18, most = -1e18;
      for (const auto& node : nodes) {
        const double error_us = node->told.at(k) - node->true_us(k);
        least = std::min(least, error_us);
        most = std::max(most, error_us);
      }
      ASSERT_LT(most - least, kAlignment_us) << "sample " << k;
    }
    for (const auto& node : nodes) {
      EXPECT_EQ(node->told.size(), static_cast<std::size_t>(kFrames)) << "a sample was lost";
      EXPECT_EQ(node->timer.restarts(), 0);
    }
  }
}

TEST(StreamTimer, NumbersSamplesByArrivalWithoutACounter) {
  HostClockSteps steps;
  Node node(100, 2000, 0, {CanTiming::period, kPeriod_us, kPeriod_us, 0}, steps);
  for (std::int64_t k = 0; k < 20000; ++k)
    if (k < 1000 || k % 37 != 0) node.timer.open_sample(0, node.stamp_us(k), {0, 0, 0, {}});
  node.timer.finish();
  EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
}

/// Returns arrivals when the host or its adapter stalls for 10 to 40 ms at times: frames due in
/// that time arrive at the end of the stall, in order.
std::vector<double> with_stalls(Node& node, std::int64_t frames, std::int64_t from) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> length_us(10'000, 40'000), apart_us(300'000, 900'000);
  std::vector<double> out;
  double begin = node.true_us(from), end = begin + length_us(random);
  for (std::int64_t k = 0; k < frames; ++k) {
    double stamp = node.stamp_us(k);
    while (stamp > end) {
      begin = end + apart_us(random);
      end = begin + length_us(random);
    }
    if (stamp > begin) stamp = end;
    if (!out.empty()) stamp = std::max(stamp, out.back() + 100);
    out.push_back(stamp);
  }
  return out;
}

TEST(StreamTimer, AStalledStreamWithoutCounterLosesAndShiftsNothing) {
  for (const double ppm : {-100.0, 0.0, 100.0})
    for (const std::int64_t from : {2, 17, 100}) {
      HostClockSteps steps;
      Node node(ppm, 300, 0, {CanTiming::period, kPeriod_us, kPeriod_us, 0}, steps);
      std::int64_t wrong = 0;
      node.timer.on_delivery([&](const TimedValues& v, double time_us) {
        node.told[v.number] = time_us;
        wrong += v.values.at(0) != static_cast<double>(v.number);
      });
      constexpr std::int64_t kFrames = 20000;
      const std::vector<double> stamps = with_stalls(node, kFrames, from);
      for (std::int64_t k = 0; k < kFrames; ++k)
        node.timer.open_sample(0, stamps[static_cast<std::size_t>(k)],
                               {0, 0, 0, {static_cast<double>(k)}});
      node.timer.finish();
      EXPECT_EQ(wrong, 0) << ppm << " ppm, from " << from;
      EXPECT_EQ(node.told.size(), static_cast<std::size_t>(kFrames));
      EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
      EXPECT_EQ(node.timer.restarts(), 0);
    }
}

TEST(StreamTimer, LossesBetweenStallsStayWhereTheyWere) {
  HostClockSteps steps;
  Node node(30, 300, 0, {CanTiming::period, kPeriod_us, kPeriod_us, 0}, steps);
  std::int64_t wrong = 0, sent = 0;
  node.timer.on_delivery([&](const TimedValues& v, double time_us) {
    node.told[v.number] = time_us;
    wrong += v.values.at(0) != static_cast<double>(v.number);
  });
  constexpr std::int64_t kFrames = 20000;
  const std::vector<double> stamps = with_stalls(node, kFrames, 100);
  const auto on_time = [&](std::int64_t k) {
    return stamps[static_cast<std::size_t>(k)] < node.true_us(k) + 600;
  };
  std::mt19937 random(37);
  for (std::int64_t k = 0; k < kFrames; ++k) {
    // After a lost frame, a late one cannot be identified.
    bool quiet = k > 100 && k < kFrames - 4;
    for (std::int64_t n = k - 3; quiet && n <= k + 3; ++n) quiet = on_time(n);
    if (quiet && random() % 50 == 0) continue;
    ++sent;
    node.timer.open_sample(0, stamps[static_cast<std::size_t>(k)],
                           {0, 0, 0, {static_cast<double>(k)}});
  }
  node.timer.finish();
  EXPECT_LT(sent, kFrames - 100);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(node.told.size(), static_cast<std::size_t>(sent));
}

TEST(StreamTimer, ASenderHeldUpForSecondsShiftsNothing) {
  HostClockSteps steps;
  // Like the SYNC of a bus that counts to 240.
  Node node(20, 300, 0, {CanTiming::counter, kPeriod_us, kPeriod_us, 240, 30e6}, steps);
  constexpr std::int64_t kFrames = 6000;
  double last = 0;
  for (std::int64_t k = 0; k < kFrames; ++k) {
    const double behind_s = k < 2000   ? 0
                            : k < 4000 ? 1.1 * std::min(1.0, 1e-3 * static_cast<double>(k - 2000))
                                       : 0;
    last = std::max(last + 100, node.stamp_us(k) + 1e6 * behind_s);
    node.timer.open_sample(static_cast<double>(k % 240), last, {0, 0, 0, {}});
  }
  node.timer.finish();
  EXPECT_EQ(node.told.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(node.timer.restarts(), 0);
  EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
}

TEST(StreamTimer, CorrectsALateStartWithoutASharpStep) {
  constexpr double kStep_us = 0.0026 * kPeriod_us;
  for (const CanTiming kind : {CanTiming::period, CanTiming::counter}) {
    // Arrival alone cannot tell a frame more than half a period late from a repeated one.
    const double late_us = kind == CanTiming::period ? 4'000 : 7'000;
    HostClockSteps steps;
    Node node(0, 200, 0, {kind, kPeriod_us, kPeriod_us, 0}, steps);
    for (std::int64_t k = 0; k < 2000; ++k)
      node.timer.open_sample(static_cast<double>(k), node.stamp_us(k) + (k < 40 ? late_us : 0),
                             {0, 0, 0, {}});
    node.timer.finish();
    ASSERT_EQ(node.told.size(), 2000u);
    for (std::int64_t k = 1; k < 2000; ++k)
      ASSERT_NEAR(node.told.at(k) - node.told.at(k - 1), kPeriod_us, kStep_us) << k;
    EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
  }
}

TEST(StreamTimer, AnOutageThatEndsWithLateFramesLeavesAGapOfItsLength) {
  HostClockSteps steps;
  Node node(0, 200, 0, counter16(), steps);
  double last = 0;
  for (std::int64_t k = 0; k < 3000; ++k) {
    if (k >= 1000 && k < 1100) continue;
    const double stamp = node.stamp_us(k);
    last = std::max(last + 300, k >= 1100 && k < 1112 ? node.true_us(1112) + 70'000 : stamp);
    node.timer.open_sample(static_cast<double>(k), last, {0, 0, 0, {}});
  }
  node.timer.finish();
  EXPECT_EQ(node.timer.restarts(), 0);
  ASSERT_EQ(node.told.size(), 2900u);
  EXPECT_EQ(node.told.upper_bound(999)->first, 1100);
  EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
}

TEST(StreamTimer, OneLateBurstIsPlacedByItsCounter) {
  HostClockSteps steps;
  Node node(0, 500, 0, counter16(), steps);
  for (std::int64_t k = 0; k < 3000; ++k) {
    double stamp = node.stamp_us(k);
    if (k >= 1000 && k < 1030) stamp = std::max(stamp, node.true_us(1030));  // an adapter stalled
    node.timer.open_sample(static_cast<double>(k), stamp, {0, 0, 0, {}});
  }
  node.timer.finish();
  EXPECT_EQ(node.told.size(), 3000u);
  EXPECT_EQ(node.timer.restarts(), 0);
  EXPECT_LT(worst_after_settling(node, 500), kAlignment_us);
}

}  // namespace stream_timer_test
}  // namespace framewatch::drivers
