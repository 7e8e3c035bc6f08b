// SPDX-License-Identifier: MIT
#include "estimator/motion/sample_merger.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace sample_merger_test {

constexpr std::int64_t kStep = 10000;  // us at 100 Hz
constexpr std::int64_t kStart = 1'000'000'000;

/// A merger of two axes with 0.05 s of lateness (5 instants), and the sets it returned.
struct Bench {
  explicit Bench(int axes = 2) : merger(axes, 100, 0.05) {}
  void push_at(std::int64_t us, int axis, double value) {
    const AccelSample sample{from_microseconds(us), axis, value};
    const bool taken = merger.push(sample);
    drain();
    if (!taken) {
      EXPECT_TRUE(merger.push(sample));
      drain();
    }
  }
  void push(std::int64_t instant, int axis, double value) {
    push_at(kStart + kStep * instant, axis, value);
  }
  void both(std::int64_t instant) {
    push(instant, 0, static_cast<double>(instant));
    push(instant, 1, -static_cast<double>(instant));
  }
  void finish() {
    merger.finish();
    drain();
  }
  void drain() {
    while (const SampleSet* set = merger.next()) out.push_back(*set);
  }
  const AxisCounters& counters(int axis) { return merger.counters_of(axis); }
  SampleMerger merger;
  std::vector<SampleSet> out;
};

TEST(SampleMerger, InstantComesOutWhenEveryAxisHasDelivered) {
  Bench b;
  b.push(0, 0, 1.5);
  EXPECT_TRUE(b.out.empty());
  b.push(0, 1, 2.5);
  ASSERT_EQ(b.out.size(), 1u);
  EXPECT_EQ(b.out[0].accel, (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(b.out[0].time, from_microseconds(kStart));
}

TEST(SampleMerger, OutOfOrderWithinTheLatenessIsOrdered) {
  Bench b;
  b.both(0);
  for (const int i : {3, 1, 4, 2}) b.push(i, 0, i);
  for (const int i : {4, 2, 3, 1}) b.push(i, 1, 10 * i);
  ASSERT_EQ(b.out.size(), 5u);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(b.out[i].index, static_cast<std::int64_t>(i));
    EXPECT_EQ(b.out[i].accel[1], 10.0 * static_cast<double>(i));
  }
  EXPECT_EQ(b.counters(0).late + b.counters(0).missing + b.counters(0).rejected, 0);
}

TEST(SampleMerger, SilentAxisHoldsUpOnceAndRecovers) {
  Bench b;
  for (int i = 0; i < 10; ++i) b.both(i);
  for (int i = 10; i < 16; ++i) b.push(i, 0, i);
  EXPECT_EQ(b.out.size(), 10u) << "waits for the lateness";
  b.push(16, 0, 16);
  EXPECT_EQ(b.out.size(), 17u) << "then it waits for no axis";
  b.push(17, 0, 17);
  EXPECT_EQ(b.out.size(), 18u);
  EXPECT_TRUE(std::isnan(b.out[17].accel[1]));
  EXPECT_EQ(b.counters(1).missing, 8);
  b.push(18, 1, 5);  // it delivers again
  b.push(18, 0, 6);
  b.push(19, 0, 7);
  EXPECT_EQ(b.out.size(), 19u) << "and is waited for again";
  b.push(19, 1, 8);
  ASSERT_EQ(b.out.size(), 20u);
  EXPECT_EQ(b.out[18].accel, (std::vector<double>{6, 5}));
  EXPECT_EQ(b.counters(1).received, 12);
}

TEST(SampleMerger, LateSampleIsCountedAndDropped) {
  Bench b;
  for (int i = 0; i < 8; ++i) b.push(i, 0, i);
  ASSERT_GE(b.out.size(), 2u);
  b.push(4, 1, 9);
  EXPECT_EQ(b.counters(1).late, 1);
  EXPECT_EQ(b.counters(1).received, 1);
  EXPECT_EQ(b.counters(1).rejected, 0);
}

TEST(SampleMerger, BadSamplesAreRejectedAndAGoodOneStillCounts) {
  Bench b;
  b.both(0);
  b.push(1, 0, std::numeric_limits<double>::quiet_NaN());
  b.push(1, 0, std::numeric_limits<double>::infinity());
  b.push_at(kStart + kStep + 4500, 0, 1);  // 0.45 of a step off the grid
  b.push(1, 0, 3);
  b.push(1, 0, 4);  // duplicate
  EXPECT_EQ(b.counters(0).rejected, 4);
  EXPECT_EQ(b.counters(0).received, 6);
  b.push(1, 1, 0);
  ASSERT_EQ(b.out.size(), 2u);
  EXPECT_EQ(b.out[1].accel[0], 3) << "the first good value counts";
}

TEST(SampleMerger, FarFutureStrayChangesNothing) {
  Bench b;
  for (int i = 0; i < 20; ++i) {
    b.both(i);
    if (i == 10) b.push(1'000'000'000, 0, 1);
  }
  ASSERT_EQ(b.out.size(), 20u);
  EXPECT_EQ(b.counters(0).rejected, 1);
  EXPECT_EQ(b.out.back().index, 19);
}

TEST(SampleMerger, TimeRunningBackwardsAnchorsAnew) {
  Bench b;
  for (int i = 0; i < 20; ++i) b.both(1000 + i);
  for (int i = 0; i < 20; ++i) b.both(i);
  const int kMax = 10;  // samples that may be lost before the new time is accepted
  EXPECT_GE(b.out.size(), 40u - kMax / 2);
  EXPECT_LE(b.counters(0).rejected + b.counters(1).rejected, kMax);
  for (std::size_t i = 1; i < b.out.size(); ++i) EXPECT_GT(b.out[i].index, b.out[i - 1].index);
  EXPECT_EQ(b.out.back().time, from_microseconds(kStart + 19 * kStep));
  EXPECT_GT(b.out[20].index, 20) << "a jump: readers see the interruption";
}

TEST(SampleMerger, ALongGapSkipsIndices) {
  Bench b;
  for (int i = 0; i < 20; ++i) b.both(i);
  for (int i = 0; i < 20; ++i) b.both(100000 + i);
  ASSERT_GT(b.out.size(), 30u);
  EXPECT_LT(b.out.size(), 60u) << "no flood of empty instants";
  EXPECT_GT(b.out[20].index, 20);
  EXPECT_EQ(b.out.back().accel[0], 100019);
}

TEST(SampleMerger, AShortGapGivesEmptyInstants) {
  Bench b;
  for (int i = 0; i < 20; ++i) b.both(i);
  for (int i = 27; i < 60; ++i) b.both(i);
  b.finish();
  ASSERT_EQ(b.out.size(), 60u);
  for (std::size_t i = 20; i < 27; ++i) EXPECT_TRUE(std::isnan(b.out[i].accel[0]));
  EXPECT_EQ(b.out[59].index, 59);
  EXPECT_EQ(b.counters(0).missing, 7);
}

TEST(SampleMerger, ClockOffByAThousandPpmIsFollowed) {
  for (const double ppm : {-1000.0, 1000.0}) {
    Bench b;
    const int kInstants = 20000;
    for (int i = 0; i < kInstants; ++i) {
      const double us = 1e4 * (1 + ppm * 1e-6) * i;
      for (int axis = 0; axis < 2; ++axis) b.push_at(kStart + std::llround(us), axis, i);
    }
    ASSERT_EQ(b.out.size(), static_cast<std::size_t>(kInstants));
    EXPECT_EQ(b.out.back().index, kInstants - 1);
    EXPECT_EQ(b.counters(0).rejected + b.counters(0).missing + b.counters(0).late, 0);
    const double expected = static_cast<double>(kStart) + 1e4 * (1 + ppm * 1e-6) * (kInstants - 1);
    EXPECT_NEAR(static_cast<double>(to_microseconds(b.out.back().time)), expected, 0.1 * kStep);
  }
}

TEST(SampleMerger, FinishDeliversOpenInstants) {
  Bench b;
  b.both(0);
  b.push(1, 0, 1);
  b.push(3, 1, 3);
  b.finish();
  ASSERT_EQ(b.out.size(), 4u);
  EXPECT_TRUE(std::isnan(b.out[2].accel[0]));
  EXPECT_EQ(b.counters(0).missing, 2);
  EXPECT_EQ(b.counters(1).missing, 2);
}

}  // namespace sample_merger_test
}  // namespace framewatch::estimator
