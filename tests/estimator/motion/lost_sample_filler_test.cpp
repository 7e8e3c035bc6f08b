// SPDX-License-Identifier: MIT
#include "estimator/motion/acquisition.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace lost_sample_filler_test {

SampleSet set_of(std::int64_t index, std::vector<double> accel) {
  return {from_microseconds(10000 * index), index, std::move(accel)};
}

/// Returns every set that the filler returns for these sets, in order.
std::vector<SampleSet> run(LostSampleFiller& filler, const std::vector<SampleSet>& sets) {
  std::vector<SampleSet> out;
  for (const SampleSet& s : sets)
    if (const SampleSet* given = filler.push(s)) out.push_back(*given);
  while (const SampleSet* given = filler.drain()) out.push_back(*given);
  return out;
}

double cubic(double t) {
  return 1 + t * (0.5 + t * (-0.3 + 0.04 * t));
}

TEST(LostSampleFiller, DelaysByTwoInstantsAndDrainsTheRest) {
  LostSampleFiller filler({1});
  EXPECT_EQ(filler.push(set_of(0, {1})), nullptr);
  EXPECT_EQ(filler.push(set_of(1, {2})), nullptr);
  ASSERT_NE(filler.push(set_of(2, {3})), nullptr);
  EXPECT_EQ(filler.drain()->index, 1);
  EXPECT_EQ(filler.drain()->index, 2);
  EXPECT_EQ(filler.drain(), nullptr);
}

TEST(LostSampleFiller, SingleLossIsTheCubicThroughItsNeighbours) {
  LostSampleFiller filler({1, 1});
  std::vector<SampleSet> sets;
  for (int i = 0; i < 12; ++i) sets.push_back(set_of(i, {i == 6 ? kNaN : cubic(i), 7.0 * i}));
  const auto out = run(filler, sets);
  ASSERT_EQ(out.size(), 12u);
  for (int i = 0; i < 12; ++i) {
    const SampleSet& s = out[static_cast<std::size_t>(i)];
    EXPECT_EQ(s.index, i);
    EXPECT_EQ(s.time, from_microseconds(10000 * i));
    EXPECT_NEAR(s.accel[0], cubic(i), 1e-12);
    EXPECT_EQ(s.accel[1], 7.0 * i);
  }
  EXPECT_EQ(filler.repaired(), (std::vector<std::int64_t>{1, 0}));
}

/// Returns the losses that remain of those at the given instants of 20.
std::vector<int> left_after(const std::vector<int>& lost, bool repair = true,
                            int interrupted_after = -1) {
  LostSampleFiller filler({static_cast<std::uint8_t>(repair)});
  std::vector<SampleSet> sets;
  for (int i = 0; i < 20; ++i) {
    const bool gone = std::find(lost.begin(), lost.end(), i) != lost.end();
    sets.push_back(
        set_of(interrupted_after >= 0 && i > interrupted_after ? i + 5 : i, {gone ? kNaN : 1.0}));
  }
  std::vector<int> left;
  const auto out = run(filler, sets);
  EXPECT_EQ(out.size(), 20u);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (std::isnan(out[i].accel[0])) left.push_back(static_cast<int>(i));
  return left;
}

TEST(LostSampleFiller, LongerLossesStay) {
  using Instants = std::vector<int>;
  EXPECT_EQ(left_after({7, 8}), (Instants{7, 8}));
  EXPECT_EQ(left_after({7, 9}), (Instants{7, 9}));
  EXPECT_EQ(left_after({7, 10}), Instants{});
  EXPECT_EQ(left_after({4, 7, 10, 13}), Instants{});
  EXPECT_EQ(left_after({0, 1, 18, 19}), (Instants{0, 1, 18, 19}));
}

TEST(LostSampleFiller, NothingIsFilledAcrossAGap) {
  using Instants = std::vector<int>;
  EXPECT_EQ(left_after({10}, true, 9), Instants{10});
  EXPECT_EQ(left_after({10}, true, 10), Instants{10});
  EXPECT_EQ(left_after({10}, true, 11), Instants{10});
  EXPECT_EQ(left_after({10}, true, 12), Instants{});
  EXPECT_EQ(left_after({10}, true, 7), Instants{});
}

TEST(LostSampleFiller, CanBeSwitchedOff) {
  EXPECT_EQ(left_after({7}, false), std::vector<int>{7});
}

}  // namespace lost_sample_filler_test
}  // namespace framewatch::estimator
