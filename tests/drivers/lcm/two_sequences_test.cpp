// SPDX-License-Identifier: MIT
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/lcm/sequence_counter.h"

namespace framewatch::drivers {
namespace two_sequences_test {

using Verdict = SequenceCounter::Verdict;
using Message = SequenceCounter::Message;

constexpr double kRate_hz = 100;
constexpr std::int64_t kPeriod_us = 10'000;
constexpr std::uint64_t kFirst = 1'000'000'000, kSecond = 2'000'000'000;  ///< digests begin here

bool is_second(const Message& m) {
  return m.digest >= kSecond;
}

/// Returns the i-th message of a sender with these offsets of number and time to the first sender.
Message message(std::int64_t i, std::uint64_t digest, std::int64_t number = 0,
                std::int64_t phase_us = 0) {
  return {100 + i + number, 1'000'000 + kPeriod_us * i + phase_us,
          1'000'000 + kPeriod_us * i + (digest >= kSecond ? 100 : 0),
          digest + static_cast<std::uint64_t>(i)};
}

struct Taken {
  std::int64_t first = 0, second = 0;
};

/// Sends the first sender alone for a second, then both by turns for 10 s.
Taken taken(SequenceCounter& counter, std::int64_t number, std::int64_t phase_us,
            bool second_comes_first = false) {
  Taken out;
  bool held_second = false;
  const auto give = [&](const Message& m) {
    const Verdict v = counter.see(m);
    if (v == Verdict::held) {
      held_second = is_second(m);
      return;
    }
    if (counter.gives_held()) (held_second ? out.second : out.first)++;
    if (v == Verdict::duplicate || v == Verdict::other) return;
    (is_second(m) ? out.second : out.first)++;
  };
  for (std::int64_t i = 0; i < 1100; ++i) {
    const Message second = message(i, kSecond, number, phase_us);
    if (i >= 100 && second_comes_first) give(second);
    give(message(i, kFirst));
    if (i >= 100 && !second_comes_first) give(second);
  }
  return out;
}

TEST(TwoSequences, KeepsTheFirstIfNumbersDistinguishThem) {
  for (const std::int64_t number : {5'000'000, 700, 100, 65, -65, -700, -5'000'000})
    for (const std::int64_t phase_us : {0, 5000, -5000})
      for (const bool before : {false, true}) {
        SequenceCounter counter(kRate_hz);
        const Taken t = taken(counter, number, phase_us, before);
        EXPECT_EQ(t.second, 0) << number << " " << phase_us << " " << before;
        EXPECT_EQ(t.first, 1100) << number << " " << phase_us << " " << before;
        EXPECT_GT(counter.others, 990) << number << " " << phase_us << " " << before;
        EXPECT_LE(counter.lost, 0) << number << " " << phase_us << " " << before;
        EXPECT_EQ(counter.backwards, 0) << number << " " << phase_us << " " << before;
      }
}

TEST(TwoSequences, NeverMixesThemAtAnyOffset) {
  for (std::int64_t number = -70; number <= 70; ++number)
    for (const std::int64_t phase_us : {0, 5000, -5000, 1, -1})
      for (const bool before : {false, true}) {
        SequenceCounter counter(kRate_hz);
        const Taken t = taken(counter, number, phase_us, before);
        const bool one_alone = t.second <= 8 || t.first <= 108;
        EXPECT_TRUE(one_alone) << number << " " << phase_us << " " << before << ": " << t.first
                               << " and " << t.second;
        EXPECT_GT(counter.conflicts + counter.others, 900)
            << number << " " << phase_us << " " << before;
      }
}

TEST(TwoSequences, StopsIndistinguishableSendersUntilOneIsLeft) {
  SequenceCounter counter(kRate_hz);
  const Taken both = taken(counter, 0, 0, true);
  EXPECT_LE(both.first + both.second, 105);
  EXPECT_GT(counter.conflicts, 990);
  EXPECT_TRUE(counter.contested(message(1100, kFirst).arrival_us));
  std::int64_t fresh = 0;
  for (std::int64_t i = 1100; i < 2000; ++i)
    fresh += counter.see(message(i, kFirst)) == Verdict::fresh;
  EXPECT_GT(fresh, 350);
  EXPECT_LT(fresh, 450);  // of the 4 s after the 5 s that must be taken
}

TEST(TwoSequences, RepeatedMessagesAreNotASecondSender) {
  SequenceCounter counter(kRate_hz);
  for (std::int64_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(counter.see(message(i, kFirst)), Verdict::fresh);
    EXPECT_EQ(counter.see(message(i, kFirst)), Verdict::duplicate);
  }
  EXPECT_EQ(counter.duplicates, 1000);
  EXPECT_EQ(counter.conflicts + counter.others, 0);
  EXPECT_FALSE(counter.contested(message(1000, kFirst).arrival_us));
}

TEST(TwoSequences, ALeapIsNotALoss) {
  SequenceCounter counter(kRate_hz);
  for (std::int64_t i = 0; i < 100; ++i) counter.see(message(i, kFirst));
  Message far = message(100, kFirst);
  for (const std::int64_t sequence :
       {std::int64_t{1'000'000}, std::int64_t{9'999'999}, std::numeric_limits<std::int64_t>::max(),
        std::numeric_limits<std::int64_t>::min(), std::int64_t{0}}) {
    far.sequence = sequence;
    far.time_us += kPeriod_us;
    far.arrival_us += kPeriod_us;
    counter.see(far);
  }
  EXPECT_EQ(counter.lost, 0);
  EXPECT_EQ(counter.leaps, 5);
  EXPECT_EQ(counter.leapt_to(), 0);
}

TEST(TwoSequences, AStampOfTomorrowDoesNotMakeALeapALoss) {
  SequenceCounter counter(kRate_hz);
  for (std::int64_t i = 0; i < 100; ++i) counter.see(message(i, kFirst));
  Message far = message(100, kFirst);
  far.sequence += 8'640'000;
  far.time_us += 86'400'000'000;
  counter.see(far);
  EXPECT_EQ(counter.lost, 0);
  EXPECT_EQ(counter.leaps, 1);
}

TEST(TwoSequences, AnOutageOfAnyLengthIsALoss) {
  SequenceCounter counter(kRate_hz);
  counter.see(message(0, kFirst));
  std::int64_t i = 0;
  for (const std::int64_t step : {2, 3, 64, 65, 1000, 360'000}) {
    i += step;
    EXPECT_EQ(counter.see(message(i, kFirst)), Verdict::fresh);
  }
  EXPECT_EQ(counter.lost, i - 6);
  EXPECT_EQ(counter.leaps, 0);
}

TEST(TwoSequences, FollowsARestartedNodeFromItsSecondMessage) {
  SequenceCounter counter(kRate_hz);
  for (std::int64_t i = 0; i < 500; ++i) counter.see(message(i, kFirst));
  EXPECT_EQ(counter.see(message(500, kFirst, -600)), Verdict::held);
  EXPECT_EQ(counter.see(message(501, kFirst, -600)), Verdict::fresh);
  EXPECT_TRUE(counter.gives_held());
  for (std::int64_t i = 502; i < 1000; ++i) {
    EXPECT_EQ(counter.see(message(i, kFirst, -600)), Verdict::fresh) << i;
    EXPECT_FALSE(counter.gives_held());
  }
  EXPECT_EQ(counter.received, 1000);
  EXPECT_EQ(counter.leaps, 1);
  EXPECT_EQ(counter.lost + counter.others + counter.backwards, 0);
}

TEST(TwoSequences, TheSecondTakesOverWhenTheFirstIsSilent) {
  SequenceCounter counter(kRate_hz);
  for (std::int64_t i = 0; i < 300; ++i) {
    counter.see(message(i, kFirst));
    if (i >= 100) counter.see(message(i, kSecond, 7000, 0));
  }
  std::int64_t fresh = 0;
  for (std::int64_t i = 300; i < 1300; ++i)
    fresh += counter.see(message(i, kSecond, 7000, 0)) == Verdict::fresh;
  EXPECT_GT(fresh, 750);
  EXPECT_LT(fresh, 810);  // silent for 2 s
}

TEST(TwoSequences, TakesANodeWithoutACounter) {
  SequenceCounter counter(kRate_hz);
  std::int64_t fresh = 0;
  for (std::int64_t i = 0; i < 1000; ++i) {
    Message m = message(i, kFirst);
    m.sequence = 0;
    fresh += counter.see(m) == Verdict::fresh;
  }
  EXPECT_EQ(fresh, 1000);
  EXPECT_EQ(counter.leaps, 999);
}

TEST(TwoSequences, LeavesOutRandomNumbersAmongANodes) {
  SequenceCounter counter(kRate_hz);
  std::mt19937_64 random(7);
  std::int64_t first = 0, second = 0;
  for (std::int64_t i = 0; i < 1000; ++i) {
    first += counter.see(message(i, kFirst)) == Verdict::fresh;
    for (int k = 0; i >= 100 && k < 5; ++k) {
      Message m = message(i, kSecond);
      m.sequence = static_cast<std::int64_t>(random());
      const Verdict v = counter.see(m);
      second += v == Verdict::fresh || v == Verdict::backwards;
    }
  }
  EXPECT_EQ(second, 0);
  EXPECT_GE(first, 990);
  EXPECT_EQ(counter.lost, 0);
}

TEST(TwoSequences, ContinuesAfterTheReceiversClockIsSetBack) {
  SequenceCounter counter(kRate_hz);
  (void)taken(counter, 0, 0);
  std::int64_t fresh = 0;
  for (std::int64_t i = 1100; i < 2000; ++i) {
    Message m = message(i, kFirst);
    m.arrival_us -= 3'600'000'000;
    fresh += counter.see(m) == Verdict::fresh;
  }
  EXPECT_GT(fresh, 350);
}

}  // namespace two_sequences_test
}  // namespace framewatch::drivers
