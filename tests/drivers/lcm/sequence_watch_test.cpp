// SPDX-License-Identifier: MIT
#include "drivers/lcm/sequence_counter.h"

#include <vector>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace sequence_watch_test {

constexpr std::int64_t kSecond_us = 1'000'000;

struct Fixture {
  SequenceWatch watch;
  SequenceWatch::Counts counts;
  std::int64_t now_us = 0;
  std::vector<SequenceWatch::News> news;

  void seconds(int count, const SequenceWatch::Counts& each) {
    for (int i = 0; i < count; ++i) {
      counts.received += each.received;
      counts.lost += each.lost;
      counts.duplicates += each.duplicates;
      counts.leaps += each.leaps;
      counts.contests += each.contests;
      now_us += kSecond_us;
      for (const auto& found : watch.update(counts, now_us))
        if (found) news.push_back(*found);
    }
  }
};

TEST(SequenceWatch, IsSilentWithoutTrouble) {
  Fixture f;
  f.seconds(1000, {100, 0, 0, 0, 0});
  EXPECT_TRUE(f.news.empty());
}

TEST(SequenceWatch, ReportsAFloodOnceUntilItEnds) {
  for (std::size_t t = 0; t < kSequenceTroubles; ++t) {
    Fixture f;
    f.seconds(20, {100, 0, 0, 0, 0});
    SequenceWatch::Counts bad{100, 0, 0, 0, 0};
    for (std::int64_t* count : {t == 0 ? &bad.contests : nullptr, t == 1 ? &bad.leaps : nullptr,
                                t == 2 ? &bad.duplicates : nullptr, t == 3 ? &bad.lost : nullptr})
      if (count != nullptr) *count = 1'000'000;
    f.seconds(100, bad);
    ASSERT_EQ(f.news.size(), 1u) << t;
    EXPECT_EQ(static_cast<std::size_t>(f.news[0].trouble), t);
    EXPECT_FALSE(f.news[0].over);
    EXPECT_EQ(f.news[0].count, 1'000'000);
    f.seconds(25, {100, 0, 0, 0, 0});
    EXPECT_EQ(f.news.size(), 1u) << t;
    f.seconds(20, {100, 0, 0, 0, 0});
    ASSERT_EQ(f.news.size(), 2u) << t;
    EXPECT_TRUE(f.news[1].over);
  }
}

TEST(SequenceWatch, IgnoresFewLosses) {
  Fixture f;
  f.seconds(100, {1000, 5, 0, 0, 0});
  EXPECT_TRUE(f.news.empty());
  f.seconds(10, {1000, 50, 0, 0, 0});
  ASSERT_EQ(f.news.size(), 1u);
  EXPECT_EQ(f.news[0].trouble, SequenceTrouble::losses);
}

TEST(SequenceWatch, AClockSetBackOnlyDelaysTheEndOfAFinding) {
  Fixture f;
  f.seconds(5, {100, 0, 0, 1, 0});
  f.now_us -= 3600 * kSecond_us;
  f.seconds(20, {100, 0, 0, 0, 0});
  EXPECT_EQ(f.news.size(), 1u);
  f.seconds(20, {100, 0, 0, 0, 0});
  EXPECT_EQ(f.news.size(), 2u);
}

}  // namespace sequence_watch_test
}  // namespace framewatch::drivers
