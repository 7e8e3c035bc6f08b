// SPDX-License-Identifier: MIT
#include "estimator/motion/axis_guard.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace axis_guard_test {

constexpr double kRate_hz = 100;
constexpr int kInstants = 1000;
constexpr int kAxes = 3;
constexpr double kStep = 1e-3;  // the sensors' resolution, m/s^2

double moving(int t, int axis) {
  return std::round(2 * std::sin(0.13 * t + axis) / kStep) * kStep;
}

struct Guarded {
  std::vector<std::vector<bool>> taken_out;  ///< samples removed, instants x axes
  std::vector<std::int64_t> stuck, clipped, missing;
};
const std::vector<std::int64_t> kNone = {0, 0, 0};

Guarded run(const std::vector<AxisGuard::Axis>& axes,
            const std::function<double(int, int)>& value) {
  AxisGuard guard(axes, kRate_hz);
  Guarded out;
  const auto take = [&](const SampleSet* set) {
    if (set == nullptr) return;
    EXPECT_EQ(set->index, static_cast<std::int64_t>(out.taken_out.size()));
    out.taken_out.emplace_back();
    for (const double v : set->accel) out.taken_out.back().push_back(std::isnan(v));
  };
  for (int t = 0; t < kInstants; ++t) {
    SampleSet set{from_microseconds(10000 * t), t, {}};
    for (int a = 0; a < static_cast<int>(axes.size()); ++a) set.accel.push_back(value(t, a));
    take(guard.push(set));
  }
  for (int i = 0; i < AxisGuard::kLookAhead; ++i) take(guard.drain());
  EXPECT_EQ(out.taken_out.size(), static_cast<std::size_t>(kInstants));
  out.stuck = guard.stuck();
  out.clipped = guard.clipped();
  out.missing = guard.missing();
  return out;
}

TEST(AxisGuard, LeavesHealthyAxesAlone) {
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes), moving);
  for (int a = 0; a < kAxes; ++a) {
    EXPECT_EQ(r.stuck[static_cast<std::size_t>(a)], 0);
    EXPECT_EQ(r.clipped[static_cast<std::size_t>(a)], 0);
  }
}

TEST(AxisGuard, RemovesEverySampleOfAnAxisThatSticksDuringMotion) {
  const int from = 400, to = 700;
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes), [&](int t, int a) {
    return moving(a == 1 && t >= from && t < to ? from : t, a);
  });
  EXPECT_EQ(r.stuck, (std::vector<std::int64_t>{0, to - from, 0}));
  for (int t = 0; t < kInstants; ++t)
    EXPECT_EQ(r.taken_out[static_cast<std::size_t>(t)][1], t >= from && t < to) << t;
}

TEST(AxisGuard, FindsAnAxisDeadFromTheStartByTheOthers) {
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes),
                        [](int t, int a) { return a == 2 ? 0.25 : moving(t, a); });
  EXPECT_GT(r.stuck[2], kInstants - 200);
  EXPECT_EQ(r.stuck[0] + r.stuck[1], 0);
}

TEST(AxisGuard, AQuietBuildingIsNotStuck) {
  const Guarded still = run(std::vector<AxisGuard::Axis>(kAxes), [](int, int) { return kStep; });
  EXPECT_EQ(still.stuck, (std::vector<std::int64_t>{0, 0, 0}));
  const Guarded dithering = run(std::vector<AxisGuard::Axis>(kAxes),
                                [](int t, int a) { return t % (150 + a) == 0 ? kStep : 0; });
  EXPECT_EQ(dithering.stuck, (std::vector<std::int64_t>{0, 0, 0}));
}

TEST(AxisGuard, ADirectionWithoutMotionIsNotStuck) {
  const std::vector<AxisGuard::Axis> axes = {{0, 0}, {0, 0}, {0, 1}, {0, 1}};
  const Guarded r = run(axes, [](int t, int a) { return a >= 2 ? 0 : moving(t, a); });
  EXPECT_EQ(r.stuck, (std::vector<std::int64_t>{0, 0, 0, 0}));
}

/// Motion in the middle of a record that is zero before and after, with the resolution of a double.
double processed(int t, int axis, int from, int to) {
  if (t < from || t >= to) return 0;
  const double rise = std::sin(M_PI * (t - from) / (to - from));
  return 0.3 * (1 + axis) * std::pow(rise, 6) * std::sin(0.31 * t + axis);
}

TEST(AxisGuard, ZerosBeforeAndAfterAProcessedRecordAreNotStuck) {
  const Guarded together = run(std::vector<AxisGuard::Axis>(kAxes),
                               [](int t, int a) { return processed(t, a, 300, 800); });
  EXPECT_EQ(together.stuck, kNone);
  EXPECT_EQ(together.missing, kNone);
  const Guarded one_by_one = run(std::vector<AxisGuard::Axis>(kAxes), [](int t, int a) {
    return processed(t, a, 300 + 4 * a, 800 - 4 * a);
  });
  EXPECT_EQ(one_by_one.stuck, kNone);
}

TEST(AxisGuard, ARecordThatStopsDuringMotionLosesHalfASecond) {
  const int end = 700, half_second = 50;
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes),
                        [](int t, int a) { return t < end ? moving(t, a) : 0; });
  EXPECT_EQ(r.stuck, kNone);
  for (int a = 0; a < kAxes; ++a) {
    EXPECT_NEAR(static_cast<double>(r.missing[static_cast<std::size_t>(a)]), half_second, 2);
    EXPECT_FALSE(r.taken_out[kInstants - 1][static_cast<std::size_t>(a)]);
  }
}

TEST(AxisGuard, ZerosOfOneAxisInStrongMotionAreStuck) {
  const int from = 450, to = 650;
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes), [](int t, int a) {
    return a == 2 && t >= from && t < to ? 0 : processed(t, a, 100, 900);
  });
  EXPECT_EQ(r.stuck, (std::vector<std::int64_t>{0, 0, to - from}));
  EXPECT_EQ(r.missing, kNone);
}

TEST(AxisGuard, ASensorCoarserThanTheQuietMotionIsNotStuck) {
  // Strong motion until 600. Then the motion is 3 steps of the fine sensors and a fiftieth of the
  // coarse one's step.
  const double coarse = 0.05;
  const auto value = [](int t, int a) {
    const double amplitude = t < 600 ? 1.0 : 0.008;
    return amplitude * (1 + 0.5 * a) * std::sin(0.41 * t + a);
  };
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes), [&](int t, int a) {
    const double step = a == 1 ? coarse : kStep;
    return std::round(value(t, a) / step) * step;
  });
  EXPECT_EQ(r.stuck, kNone);
  EXPECT_EQ(r.missing, kNone);
}

TEST(AxisGuard, FindsASensorThatSticksBeforeTheShakingWithinASecond) {
  const int onset = 500;
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes), [](int t, int a) {
    const double amplitude = t < onset ? 0.004 : 2.0;
    if (a == 1 && t > 300) return 0.003;  // it moved before, while the building was quiet
    return std::round(amplitude * std::sin(0.13 * t + a) / kStep) * kStep;
  });
  EXPECT_EQ(r.stuck[0] + r.stuck[2], 0);
  EXPECT_GE(r.stuck[1], kInstants - onset - 100);
  EXPECT_FALSE(r.taken_out[onset - 10][1]);
}

TEST(AxisGuard, ComparesASingleAxisWithOtherDirections) {
  const std::vector<AxisGuard::Axis> axes = {{0, 0}, {0, 0}, {0, 1}};
  const Guarded r =
      run(axes, [](int t, int a) { return a == 2 && t >= 400 && t < 700 ? 0.5 : moving(t, a); });
  EXPECT_EQ(r.stuck, (std::vector<std::int64_t>{0, 0, 300}));
}

TEST(AxisGuard, RemovesSamplesAtTheConfiguredRangeAndTheirNeighbours) {
  std::vector<AxisGuard::Axis> axes(kAxes);
  axes[1].range = 1.5;
  const Guarded r =
      run(axes, [](int t, int a) { return std::min(moving(t, a), a == 1 ? 1.5 : 9.0); });
  EXPECT_GT(r.clipped[1], kInstants / 5);
  EXPECT_EQ(r.clipped[0] + r.clipped[2], 0);
  for (int t = 1; t + 1 < kInstants; ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (moving(t, 1) < 1.5) continue;
    EXPECT_TRUE(r.taken_out[i - 1][1] && r.taken_out[i][1] && r.taken_out[i + 1][1]) << t;
  }
}

TEST(AxisGuard, LearnsARangeIfNoneIsConfigured) {
  const Guarded r = run(std::vector<AxisGuard::Axis>(kAxes),
                        [](int t, int a) { return std::min(moving(t, a), a == 0 ? 1.2 : 9.0); });
  for (int t = kInstants / 2; t < kInstants; ++t) {  // the guard must see its resolution first
    if (moving(t, 0) >= 1.2) {
      EXPECT_TRUE(r.taken_out[static_cast<std::size_t>(t)][0]) << t;
    }
  }
  EXPECT_EQ(r.clipped[1] + r.clipped[2], 0);
}

}  // namespace axis_guard_test
}  // namespace framewatch::estimator
