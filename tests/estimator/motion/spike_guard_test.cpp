// SPDX-License-Identifier: MIT
#include "estimator/motion/axis_guard.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/motion/acquisition.h"

namespace framewatch::estimator {
namespace spike_guard_test {

constexpr double kRate_hz = 100;
constexpr int kInstants = 1200;
constexpr int kAxes = 4;
constexpr double kNoise = 1e-3;  // m/s^2
constexpr int kAt = 700;

using Places = std::set<std::pair<int, int>>;  // instant, axis

/// The results for noise, equal in every test, plus the motion that the test adds.
struct Guarded {
  Places absurd;
  std::vector<std::int64_t> counted;
};
Guarded run(const std::function<double(int t, int axis)>& added, int axes = kAxes,
            double resolution = 0, const std::vector<int>& groups = {}) {
  std::vector<AxisGuard::Axis> guarded(static_cast<std::size_t>(axes));
  for (std::size_t a = 0; a < groups.size(); ++a) guarded[a].group = groups[a];
  AxisGuard guard(guarded, kRate_hz);
  Guarded out;
  std::mt19937 random(1);
  const auto take = [&](const SampleSet* set) {
    if (set == nullptr) return;
    for (int a = 0; a < axes; ++a)
      if (std::isnan(set->accel[static_cast<std::size_t>(a)]))
        out.absurd.insert({static_cast<int>(set->index), a});
  };
  for (int t = 0; t < kInstants; ++t) {
    SampleSet set{from_microseconds(10000 * t), t, {}};
    for (int a = 0; a < axes; ++a) {
      const double noise = kNoise * (static_cast<double>(random()) / 2147483648.0 - 1);
      const double value = noise + added(t, a);
      set.accel.push_back(resolution > 0 ? std::round(value / resolution) * resolution : value);
    }
    take(guard.push(set));
  }
  while (const SampleSet* set = guard.drain()) take(set);
  out.counted = guard.absurd();
  return out;
}

Places row(int from, int to, int axis) {
  Places out;
  for (int t = from; t < to; ++t) out.insert({t, axis});
  return out;
}

TEST(SpikeGuard, RemovesAFewOutlyingSamplesOnOneAxis) {
  for (const int length : {1, 2, 3, 100})
    for (const double size : {0.1, -3.0, 150.0}) {
      const Guarded g = run([&](int t, int axis) {
        return axis == 2 && t >= kAt && t < kAt + length ? size * (1 + 1e-3 * (t % 7)) : 0;
      });
      EXPECT_EQ(g.absurd, row(kAt, kAt + length, 2)) << length << " of " << size;
      EXPECT_EQ(g.counted, (std::vector<std::int64_t>{0, 0, length, 0}));
    }
}

TEST(SpikeGuard, KeepsAnOnsetAfterAnyQuiet) {
  const auto onset = [](int t, int axis) {  // floors follow the base
    const int since = t - kAt - axis;
    return since < 0 ? 0.0 : 3 * std::cos(0.3 * since);
  };
  EXPECT_TRUE(run(onset).absurd.empty());
}

TEST(SpikeGuard, KeepsATapThatOtherAxesFeel) {
  const auto tap = [](int t, int axis) {
    if (t < kAt || axis == 3) return 0.0;
    const double ring = std::exp(-0.1 * (t - kAt)) * std::cos(0.9 * (t - kAt));
    return axis == 0 ? (t == kAt ? 20 : 0.2 * ring) : 0.1 * ring;
  };
  EXPECT_TRUE(run(tap).absurd.empty());
}

TEST(SpikeGuard, KeepsAnImpactThatRingsDown) {
  const auto impact = [](int t, int axis) {
    return axis == 1 && t >= kAt ? std::pow(-0.5, t - kAt) * 0.08 : 0;
  };
  EXPECT_TRUE(run(impact).absurd.empty());
}

TEST(SpikeGuard, KeepsAPulseThatRisesOverSomeSamples) {
  // An impact against a stop on one floor of a moving building (case-040).
  const std::vector<double> rise{0.3, 1.2, 3.2, 4.8, 5.9, 6.5, 6.4, 5.8, 4.5, 3.0, 1.5, 0.5};
  const auto pulse = [&](int t, int axis) {
    const auto since = static_cast<std::size_t>(std::max(0, t - kAt));
    const bool hit = axis == 1 && t >= kAt && since < rise.size();
    return 1.2 * std::sin(0.03 * t + axis) + (hit ? rise[since] : 0);
  };
  EXPECT_TRUE(run(pulse).absurd.empty());
}

TEST(SpikeGuard, KeepsAJerkOfAShakingTable) {
  // A real impact at the base alone: mini_shake_table_xsens_2025, Northridge.
  const std::vector<double> jerk{0.575, 3.336, 0.0001, -0.320, 2.086, -0.712, -0.606, -0.011};
  EXPECT_TRUE(run([&](int t, int axis) {
                const auto since = static_cast<std::size_t>(std::max(0, t - kAt));
                return axis == 0 && t >= kAt && since < jerk.size() ? jerk[since] : 0;
              }).absurd.empty());
}

TEST(SpikeGuard, RemovesAlternatingSpikes) {
  const Guarded g = run([&](int t, int axis) {
    return axis == 1 && t >= kAt && t < kAt + 40 && t % 2 == 0 ? 50 : 0;
  });
  EXPECT_EQ(g.counted, (std::vector<std::int64_t>{0, 20, 0, 0}));
}

TEST(SpikeGuard, KeepsAStepOfTheBias) {
  const Guarded g = run([](int t, int axis) { return axis == 1 && t >= kAt ? 5.0 : 0; });
  const auto longest = static_cast<int>(SpikeGuard::kLongest_s * kRate_hz);
  EXPECT_GT(g.counted[1], 0);
  EXPECT_LE(g.counted[1], longest + 1);
  EXPECT_LT(g.absurd.rbegin()->first, kAt + longest + 2);
}

TEST(SpikeGuard, KeepsSpikesOfASingleAxis) {
  EXPECT_TRUE(run([](int t, int) { return t == kAt ? 5.0 : 0; }, 1).absurd.empty());
}

TEST(SpikeGuard, KeepsStepsOfACoarseSensor) {
  // With a resolution of 40 times the noise, the value mostly stays, then goes one step and back.
  constexpr double kStep = 40 * kNoise;
  const auto toggles = [](int t, int axis) {
    return (t + 13 * axis) % 97 == 0 || (t > 900 && axis == 1 && t % 3 == 0) ? kStep : 0;
  };
  EXPECT_TRUE(run(toggles, kAxes, kStep).absurd.empty());
}

TEST(SpikeGuard, KeepsMotionAfterAStuckSecond) {
  const auto motion = [](int t, int axis) {
    return axis == 2 && t >= kAt && t < kAt + 100 ? -1e9 : std::sin(0.2 * t + axis);
  };
  const Guarded g =
      run([&](int t, int axis) { return motion(t, axis) == -1e9 ? 0.5 : motion(t, axis); });
  EXPECT_EQ(g.counted, (std::vector<std::int64_t>{0, 0, 0, 0}));
}

TEST(SampleBound, AppliesToScaledValuesAboutTheOffset) {
  SensorAxis axis;
  EXPECT_TRUE(sample_bound(axis).holds(-kMaxAccel));
  EXPECT_FALSE(sample_bound(axis).holds(std::nextafter(kMaxAccel, 1e3)));
  EXPECT_FALSE(sample_bound(axis).holds(std::nan("")));
  EXPECT_FALSE(sample_bound(axis).holds(5e-324));
  EXPECT_TRUE(sample_bound(axis).holds(-0.0));
  axis.offset = 500;
  EXPECT_TRUE(sample_bound(axis).holds(310));
  EXPECT_FALSE(sample_bound(axis).holds(0));
  axis.range = 1000;
  EXPECT_TRUE(sample_bound(axis).holds(-1000));
  EXPECT_FALSE(sample_bound(axis).holds(1300));
}

TEST(SpikeGuardGroups, AnAxisOfTheSameNodeIsNoWitness) {
  const auto both = [](int t, int axis) { return t == kAt && (axis == 1 || axis == 2) ? 20.0 : 0; };
  EXPECT_TRUE(run(both, kAxes, 0, {0, 1, 2, 3}).absurd.empty());
  EXPECT_EQ(run(both, kAxes, 0, {0, 1, 1, 3}).absurd, (Places{{kAt, 1}, {kAt, 2}}));
}

TEST(SpikeGuardGroups, InOneGroupAxesAreTheOnlyWitnesses) {
  const auto both = [](int t, int axis) { return t == kAt && (axis == 1 || axis == 2) ? 20.0 : 0; };
  EXPECT_TRUE(run(both, kAxes, 0, {7, 7, 7, 7}).absurd.empty());
}

}  // namespace spike_guard_test
}  // namespace framewatch::estimator
