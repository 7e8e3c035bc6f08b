// SPDX-License-Identifier: MIT
#include "drivers/can/arrival_numbering.h"

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace arrival_numbering_test {

constexpr double kShare = 0.05;

using Numbers = std::vector<std::int64_t>;

/// Returns the numbers of frames with these arrivals after a frame that was due at 0.
Numbers numbers(const std::vector<double>& arrivals) {
  Numbers out;
  ArrivalNumbering told;
  std::int64_t last = 0;
  for (const double at : arrivals) {
    told.add(at - static_cast<double>(last), kShare);
    if (!told.unambiguous()) continue;
    const std::int64_t before = last;
    for (const std::int64_t n : told.assign_numbers()) out.push_back(last = before + n);
  }
  const std::int64_t before = last;
  for (const std::int64_t n : told.assign_numbers()) out.push_back(before + n);
  return out;
}

TEST(ArrivalNumbering, CountsPeriods) {
  EXPECT_EQ(numbers({1.0, 2.02, 3.3, 4.01}), (Numbers{1, 2, 3, 4}));
}

TEST(ArrivalNumbering, SkipsTheNumbersOfLostFrames) {
  EXPECT_EQ(numbers({1.0, 3.02, 4.3, 8.01, 9.01, 10.0}), (Numbers{1, 3, 4, 8, 9, 10}));
}

TEST(ArrivalNumbering, GivesALateFrameItsOwnNumber) {
  EXPECT_EQ(numbers({1.0, 3.02, 3.04, 4.01, 5}), (Numbers{1, 2, 3, 4, 5}));
  EXPECT_EQ(numbers({1.0, 2.97, 3.01, 4.01, 5}), (Numbers{1, 2, 3, 4, 5}));
}

TEST(ArrivalNumbering, NumbersABurstAfterAStallOneByOne) {
  EXPECT_EQ(numbers({1.0, 5.4, 5.41, 5.42, 5.43, 6.0, 7.0}), (Numbers{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(numbers({1.0, 4.5, 4.8, 5.1, 5.4, 6.0, 7.0}), (Numbers{1, 2, 3, 4, 5, 6, 7}));
}

TEST(ArrivalNumbering, SkipsTheNumberBeforeALateFrameAfterALoss) {
  EXPECT_EQ(numbers({1.0, 4.4, 4.5, 5.0, 6.0}), (Numbers{1, 3, 4, 5, 6}));
}

TEST(ArrivalNumbering, GivesARepeatedFrameTheSameNumber) {
  EXPECT_EQ(numbers({1.0, 1.03, 2.0, 2.1, 3.0}), (Numbers{1, 1, 2, 2, 3}));
}

TEST(ArrivalNumbering, GivesASlightlyEarlyFrameTheNextNumber) {
  EXPECT_EQ(numbers({0.8, 1.7, 2.9, 4.0}), (Numbers{1, 2, 3, 4}));
}

TEST(ArrivalNumbering, AcceptsAConfirmedNumberOnlyIfTheFrameWasDue) {
  ArrivalNumbering told;
  told.add(2.3, kShare);
  EXPECT_FALSE(told.unambiguous());
  EXPECT_FALSE(told.confirm(3)) << "it would have come before it was due";
  EXPECT_FALSE(told.confirm(0));
  EXPECT_TRUE(told.confirm(1));
  EXPECT_EQ(told.assign_numbers(), Numbers{1});
}

TEST(ArrivalNumbering, WaitsForABoundedNumberOfFrames) {
  ArrivalNumbering told;
  int added = 0;
  while (!told.unambiguous() && added < 1000) told.add(2.6 + added++, kShare);
  EXPECT_EQ(added, 64);
}

TEST(ArrivalNumbering, PutsFirstFramesOnTheGridOfTheMajority) {
  EXPECT_EQ(first_numbers({0, 1, 2, 3}), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(first_numbers({0, 1.7, 2, 3, 4}), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_EQ(first_numbers({0.6, 1, 2, 4, 5}), (Numbers{0, 1, 2, 4, 5}));
  EXPECT_EQ(first_numbers({2.4, 2.41, 2.42, 3, 4, 5}), (Numbers{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(first_numbers({}).empty());
}

}  // namespace arrival_numbering_test
}  // namespace framewatch::drivers
