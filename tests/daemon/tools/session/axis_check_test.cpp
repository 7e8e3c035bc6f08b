// SPDX-License-Identifier: MIT
#include "daemon/tools/session/axis_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace axis_check_test {

// Limits.
constexpr double kNoiseError = 0.15;  // of a density measured over 20 s
constexpr double kOffsetError_mps2 = 1e-3;

constexpr double kRate_hz = 100, kDensity = 5e-4;
constexpr unsigned kSeed = 11;

std::vector<estimator::SensorAxis> axes(std::size_t count) {
  std::vector<estimator::SensorAxis> out(count);
  for (std::size_t a = 0; a < count; ++a) {
    out[a].name = "axis" + std::to_string(a);
    out[a].noise_density = kDensity;
    out[a].range = 20;
  }
  return out;
}

std::vector<ChannelResult> checked(const std::vector<estimator::SensorAxis>& of,
                                   const std::function<double(std::size_t, int, double)>& value,
                                   std::vector<estimator::AxisCounters> counters = {}) {
  ChannelCheck check(of, kRate_hz);
  std::mt19937 random(kSeed);
  std::normal_distribution<double> noise(0, kDensity * std::sqrt(kRate_hz / 2));
  estimator::SampleSet set;
  for (int i = 0; i < 2000; ++i) {
    set.accel.clear();
    for (std::size_t a = 0; a < of.size(); ++a) set.accel.push_back(value(a, i, noise(random)));
    check.push(set);
  }
  counters.resize(of.size());
  return check.results(counters);
}

TEST(ChannelCheck, MeasuresNoiseOffsetAndPeak) {
  const auto found = checked(
      axes(2), [](std::size_t a, int, double noise) { return noise + (a == 0 ? 0.25 : -0.1); });
  for (const ChannelResult& r : found) {
    EXPECT_NEAR(r.noise_density / kDensity, 1, kNoiseError);
    EXPECT_EQ(r.samples, 2000);
    EXPECT_EQ(r.problem, "");
  }
  EXPECT_NEAR(found[0].offset, 0.25, kOffsetError_mps2);
  EXPECT_NEAR(found[1].offset, -0.1, kOffsetError_mps2);
  EXPECT_GT(found[0].peak, 0.25);
  EXPECT_NEAR(found[0].rms, kDensity * std::sqrt(kRate_hz / 2), 2e-4);
}

TEST(ChannelCheck, ReportsProblemsOfAChannel) {
  std::vector<estimator::AxisCounters> counters(7);
  counters[1].clipped = 3;
  const auto found = checked(
      axes(7),
      [](std::size_t a, int i, double noise) -> double {
        switch (a) {
          case 0:
            return NAN;  // dead
          case 2:
            return 0.5;  // stands still
          case 3:
            return i % 20 == 0 ? NAN : noise;  // loses samples
          case 4:
            return i == 700 ? 19.0 : noise;  // near its range
          case 5:
            return 5 * noise;  // noisy
          case 6:
            return 9.8 + noise;  // upright
          default:
            return noise;
        }
      },
      counters);
  const char* words[] = {"no samples",           "saturated: 3",      "stands still",
                         "5.0 % of its samples", "95 % of its range", "noise",
                         "rests at +9.80"};
  for (std::size_t a = 0; a < found.size(); ++a)
    EXPECT_NE(found[a].problem.find(words[a]), std::string::npos) << found[a].problem;
}

TEST(RestLevel, FollowsAnOffsetButNotTheMotion) {
  RestLevel rest(1, kRate_hz);
  double largest_at_rest = 0, peak = 0;
  for (int i = 0; i < 1500; ++i) {
    const double shake = i >= 1000 ? std::sin(2 * M_PI * 3 * i / kRate_hz) : 0;
    const double distance = rest.push({estimator::Time{}, i, {9.81 + 0.001 * (i % 3) + shake}})[0];
    if (i < 100)
      EXPECT_TRUE(std::isnan(distance));
    else
      (i < 1000 ? largest_at_rest : peak) =
          std::max(i < 1000 ? largest_at_rest : peak, std::abs(distance));
  }
  EXPECT_LT(largest_at_rest, 0.01);
  EXPECT_GT(peak, 0.9);
}

/// A blow of 20 ms on one of three sensors of a frame that then rings at 3 Hz with 1 % damping.
/// The others feel half of the ringing.
std::vector<TapTest::Tap> taps_of(const std::vector<std::pair<int, double>>& blows_mps2,
                                  double share = 0.5) {
  TapTest test(3, kRate_hz);
  std::vector<TapTest::Tap> found;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> noise(0, 0.003);
  const std::vector<double> threshold(3, 0.05);
  std::vector<double> ringing(3, 0.0);
  double since_s = 1e9;
  for (int i = 0; i < 400 * static_cast<int>(blows_mps2.size()); ++i, since_s += 1 / kRate_hz) {
    std::vector<double> distance(3);
    const auto [axis, blow] = blows_mps2[static_cast<std::size_t>(i / 400)];
    const bool hit = i % 400 == 100 || i % 400 == 101;
    if (i % 400 == 101) {
      since_s = 0;
      for (int a = 0; a < 3; ++a)
        ringing[static_cast<std::size_t>(a)] = -0.3 * blow * (a == axis ? 1 : share);
    }
    for (int a = 0; a < 3; ++a) {
      const auto at = static_cast<std::size_t>(a);
      distance[at] = noise(random) + (hit ? blow * (a == axis ? 1 : 0.3 * share) : 0);
      if (!hit)
        distance[at] += ringing[at] * std::exp(-0.01 * 19 * since_s) * std::sin(19 * since_s + 0.3);
    }
    if (const auto tap = test.push(distance, threshold)) found.push_back(*tap);
  }
  return found;
}

TEST(TapTest, FindsSensorAndDirectionDespiteRinging) {
  const auto found = taps_of({{1, 2.0}, {0, -1.5}, {2, 1.8}, {1, -2.2}});
  ASSERT_EQ(found.size(), 4u);
  const int axis[] = {1, 0, 2, 1}, sign[] = {1, -1, 1, -1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found[i].axis, axis[i]) << i;
    EXPECT_EQ(found[i].sign, sign[i]) << i;
  }
}

TEST(TapTest, AssignsABlowThatAllFeelToNoSensor) {
  const auto found = taps_of({{1, 2.0}}, 10.0 / 3);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].axis, -1);
}

TEST(TapTest, IgnoresNoiseAndMissingSamples) {
  TapTest test(2, kRate_hz);
  for (int i = 0; i < 1000; ++i)
    EXPECT_FALSE(test.push({i % 7 == 0 ? NAN : 0.04 * std::sin(i), NAN}, {0.05, 0.05}));
}

}  // namespace axis_check_test
}  // namespace framewatch::daemon
