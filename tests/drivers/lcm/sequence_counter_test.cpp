// SPDX-License-Identifier: MIT
#include "drivers/lcm/sequence_counter.h"

#include <limits>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace sequence_counter_test {

using Verdict = SequenceCounter::Verdict;

TEST(SequenceCounter, CountsMissingNumbersAsLost) {
  SequenceCounter counter;
  for (const std::int64_t s : {5, 6, 9, 10, 200}) EXPECT_EQ(counter.see(s, s), Verdict::fresh);
  EXPECT_EQ(counter.received, 5);
  EXPECT_EQ(counter.lost, 2 + 189);
  EXPECT_EQ(counter.leaps, 0);
}

TEST(SequenceCounter, ALateMessageIsNoLongerLost) {
  SequenceCounter counter;
  for (const std::int64_t s : {1, 2, 5, 3, 6, 4}) EXPECT_EQ(counter.see(s, s), Verdict::fresh);
  EXPECT_EQ(counter.lost, 0);
  EXPECT_EQ(counter.reordered, 2);
  EXPECT_EQ(counter.received, 6);
}

TEST(SequenceCounter, CountsDuplicates) {
  SequenceCounter counter;
  for (const std::int64_t s : {1, 2, 3}) EXPECT_EQ(counter.see(s, s), Verdict::fresh);
  EXPECT_EQ(counter.see(3, 3), Verdict::duplicate);
  EXPECT_EQ(counter.see(2, 2), Verdict::duplicate);
  EXPECT_EQ(counter.duplicates, 2);
  EXPECT_EQ(counter.received, 3);
  EXPECT_EQ(counter.lost, 0);
}

TEST(SequenceCounter, ARestartedNodeIsNoLoss) {
  SequenceCounter counter;
  counter.see(1000, 1000);
  EXPECT_EQ(counter.see(0, 1001), Verdict::fresh);
  EXPECT_EQ(counter.see(1, 1002), Verdict::fresh);
  EXPECT_EQ(counter.leaps, 1);
  EXPECT_EQ(counter.lost, 0);
}

TEST(SequenceCounter, FollowsTimeThatRunsBackwards) {
  SequenceCounter counter;
  counter.see(1, 100);
  EXPECT_EQ(counter.see(2, 50), Verdict::backwards);
  EXPECT_EQ(counter.see(3, 60), Verdict::fresh);
  counter.see(500, 1000);
  EXPECT_EQ(counter.see(0, 10), Verdict::backwards);
  EXPECT_EQ(counter.see(1, 20), Verdict::fresh);
  EXPECT_EQ(counter.backwards, 2);
}

TEST(SequenceCounter, AnyNumbersAreSafe) {
  SequenceCounter counter;
  constexpr auto lowest = std::numeric_limits<std::int64_t>::min();
  constexpr auto highest = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t s : {highest, lowest, std::int64_t{0}, lowest, highest})
    for (const std::int64_t t : {lowest, highest, std::int64_t{0}}) counter.see(s, t);
  EXPECT_GE(counter.lost, 0);
}

}  // namespace sequence_counter_test
}  // namespace framewatch::drivers
