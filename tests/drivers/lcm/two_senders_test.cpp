// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/accel_intake.h"

namespace framewatch::drivers {
namespace two_senders_test {

constexpr LcmSender kNode{0x7F000001, 40000}, kTwin{0x7F000001, 40001};
constexpr double kTrue_mps2 = 1, kTwins_mps2 = 0.8;
constexpr std::int64_t kPeriod_us = 10'000;

struct Fixture {
  std::vector<estimator::AccelSample> samples;
  std::vector<IntakeNotice> notices;
  AccelIntake intake;
  explicit Fixture(TwoSenders two_senders = TwoSenders::first)
      : intake({{"one", "ACCEL", 1, 0}, {"two", "ACCEL", 2, 0}, {"named", "", -1, 0}},
               [this](const estimator::AccelSample& s) { samples.push_back(s); },
               {100, two_senders}) {
    intake.on_notice([this](const IntakeNotice& n) { notices.push_back(n); });
  }

  IntakeResult accel(std::int64_t i, double value, const LcmSender& sender, std::int32_t node = 1,
                     std::int64_t number = 0) {
    const auto bytes = encode_accel(
        {estimator::from_microseconds(kPeriod_us * (i + 1)), i + number, node, {value, 0, 0}});
    return intake.message("ACCEL", bytes.data(), bytes.size(), sender, received_us(i));
  }
  IntakeResult table(std::int64_t i, std::vector<std::string> names,
                     std::vector<AxisAddress> addresses) {
    const auto bytes =
        AccelMessages(std::move(names), std::move(addresses), 100).tables(0).front().bytes;
    return intake.message("ACCEL_CHANNELS", bytes.data(), bytes.size(), {}, received_us(i));
  }
  static std::int64_t received_us(std::int64_t i) { return 1'700'000'000'000'000 + kPeriod_us * i; }
  std::int64_t taken(double value, int axis = 0) const {
    return std::count_if(samples.begin(), samples.end(), [&](const estimator::AccelSample& s) {
      return s.axis == axis && s.accel == value;
    });
  }
};

/// Sends the node alone for a second, then `seconds` with a twin whose messages always come first.
void both(Fixture& f, int seconds, const LcmSender& node, const LcmSender& twin,
          std::int64_t number = 0) {
  for (std::int64_t i = 0; i < 100 + 100 * seconds; ++i) {
    if (i >= 100) f.accel(i, kTwins_mps2, twin, 1, number);
    f.accel(i, kTrue_mps2, node);
    f.accel(i, kTrue_mps2, node, 2);
  }
}

TEST(TwoSenders, OnlyTheBoundAddressContinues) {
  Fixture f;
  both(f, 10, kNode, kTwin);
  EXPECT_EQ(f.taken(kTrue_mps2), 1100);
  EXPECT_EQ(f.taken(kTwins_mps2), 0);
  EXPECT_EQ(f.taken(kTrue_mps2, 1), 1100);
  EXPECT_EQ(f.intake.counters().other_sender, 1000);
  EXPECT_EQ(f.intake.node_of(0)->left_out(), 1000);
  ASSERT_EQ(f.notices.size(), 1u);
  EXPECT_EQ(f.notices[0].trouble, SequenceTrouble::two_senders);
  EXPECT_EQ(f.notices[0].axis, 0u);
  EXPECT_EQ(f.notices[0].node, 1);
  EXPECT_EQ(f.notices[0].stream, "ACCEL");
  EXPECT_EQ(f.notices[0].bound, kNode);
  EXPECT_EQ(f.notices[0].other, kTwin);
}

TEST(TwoSenders, StopsBothIfSoConfigured) {
  Fixture f(TwoSenders::none);
  both(f, 10, kNode, kTwin);
  EXPECT_EQ(f.taken(kTrue_mps2), 100);
  EXPECT_EQ(f.taken(kTwins_mps2), 0);
  EXPECT_EQ(f.taken(kTrue_mps2, 1), 1100) << "the other node is not concerned";
  EXPECT_EQ(f.intake.node_of(0)->withheld, 1000);
  for (std::int64_t i = 1100; i < 2000; ++i) f.accel(i, kTrue_mps2, kNode);
  EXPECT_GT(f.taken(kTrue_mps2), 100 + 350);  // after 5 s with one alone
}

TEST(TwoSenders, WithoutAddressesEqualNumbersWithOtherContentsStopTheNode) {
  Fixture f;
  both(f, 10, {}, {});
  EXPECT_LE(f.taken(kTwins_mps2), 4);
  EXPECT_LE(f.taken(kTrue_mps2), 103);
  EXPECT_EQ(f.taken(kTrue_mps2, 1), 1100);
  ASSERT_FALSE(f.notices.empty());
  EXPECT_EQ(f.notices[0].trouble, SequenceTrouble::two_senders);
  EXPECT_GE(f.intake.counters().duplicate, 990);
}

TEST(TwoSenders, WithoutAddressesTheFirstNumberingContinues) {
  Fixture f;
  both(f, 10, {}, {}, 5'000'000);
  EXPECT_EQ(f.taken(kTwins_mps2), 0);
  EXPECT_EQ(f.taken(kTrue_mps2), 1100);
  EXPECT_EQ(f.intake.lost(), 0);
  ASSERT_FALSE(f.notices.empty());
  EXPECT_EQ(f.notices[0].trouble, SequenceTrouble::two_senders);
}

TEST(TwoSenders, ReportsAFloodOnceAndItsEndOnce) {
  Fixture f;
  for (std::int64_t i = 0; i < 10'000; ++i) {
    f.accel(i, kTrue_mps2, kNode);
    for (std::uint16_t port = 1; i >= 100 && i < 3000 && port < 20; ++port)
      f.accel(i, kTwins_mps2, {0x0A000001, port});
  }
  EXPECT_EQ(f.taken(kTwins_mps2), 0);
  EXPECT_EQ(f.taken(kTrue_mps2), 10'000);
  ASSERT_EQ(f.notices.size(), 2u);
  EXPECT_FALSE(f.notices[0].over);
  EXPECT_TRUE(f.notices[1].over);
}

TEST(TwoSenders, AnotherTakesOverFromASilentSender) {
  Fixture f;
  for (std::int64_t i = 0; i < 100; ++i) f.accel(i, kTrue_mps2, kNode);
  for (std::int64_t i = 100; i < 1000; ++i) f.accel(i, kTwins_mps2, kTwin, 1, -90);
  EXPECT_NEAR(static_cast<double>(f.taken(kTwins_mps2)), 700, 2);
  for (const IntakeNotice& n : f.notices) EXPECT_NE(n.trouble, SequenceTrouble::two_senders);
}

TEST(TwoSenders, ReportsDuplicatesLeapsAndLosses) {
  Fixture f;
  for (std::int64_t i = 0; i < 1000; ++i)
    for (int twice = 0; twice < 2; ++twice) f.accel(i, kTrue_mps2, kNode);
  ASSERT_EQ(f.notices.size(), 1u);
  EXPECT_EQ(f.notices[0].trouble, SequenceTrouble::duplicates);
  Fixture g;
  for (std::int64_t i = 0; i < 1000; ++i) g.accel(i, kTrue_mps2, kNode, 1, i < 500 ? 0 : 900'000);
  ASSERT_EQ(g.notices.size(), 1u);
  EXPECT_EQ(g.notices[0].trouble, SequenceTrouble::leaps);
  EXPECT_EQ(g.notices[0].from, 499);
  EXPECT_EQ(g.notices[0].to, 900'500);
  EXPECT_EQ(g.intake.lost(), 0);
  Fixture h;
  for (std::int64_t i = 0; i < 1000; ++i)
    if (i % 20 != 7) h.accel(i, kTrue_mps2, kNode);
  ASSERT_EQ(h.notices.size(), 1u);
  EXPECT_EQ(h.notices[0].trouble, SequenceTrouble::losses);
}

TEST(TwoSenders, ReportsAContradictingTableOnceAndIgnoresIt) {
  Fixture f;
  for (std::int64_t i = 0; i < 10'000; ++i) {
    if (i < 1000) f.table(i, {"two", "one"}, {{"ACCEL", 1, 0}, {"ACCEL", 2, 0}});
    f.accel(i, kTrue_mps2, kNode, 1);
    f.accel(i, kTwins_mps2, kNode, 2);
  }
  EXPECT_EQ(f.taken(kTrue_mps2, 0), 10'000);
  EXPECT_EQ(f.taken(kTwins_mps2, 1), 10'000);
  ASSERT_EQ(f.notices.size(), 4u);
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_TRUE(f.notices[n].of_table);
    EXPECT_EQ(f.notices[n].axis, n % 2);
    EXPECT_EQ(f.notices[n].over, n >= 2);
  }
  EXPECT_EQ(f.intake.counters().elsewhere, 2000);
}

TEST(TwoSenders, ATableMovesAChannelOnlyWhenItsNodeIsSilent) {
  Fixture f;
  f.table(0, {"named"}, {{"ACCEL", 7, 0}});
  for (std::int64_t i = 0; i < 200; ++i) {
    if (i == 100) f.table(i, {"named"}, {{"ACCEL", 8, 0}});
    f.accel(i, kTrue_mps2, kNode, 7);
    f.accel(i, kTwins_mps2, kNode, 8);
  }
  EXPECT_EQ(f.taken(kTrue_mps2, 2), 200);
  EXPECT_EQ(f.taken(kTwins_mps2, 2), 0);
  EXPECT_EQ(f.notices.size(), 1u);
  for (std::int64_t i = 200; i < 2000; ++i) {
    if (i % 100 == 0) f.table(i, {"named"}, {{"ACCEL", 8, 0}});
    f.accel(i, kTwins_mps2, kNode, 8);
  }
  EXPECT_NEAR(static_cast<double>(f.taken(kTwins_mps2, 2)), 700, 100);  // 10 s after the last one
}

TEST(TwoSenders, ANewLogMayBindAgain) {
  Fixture f;
  f.table(0, {"named"}, {{"ACCEL", 7, 0}});
  for (std::int64_t i = 0; i < 100; ++i) f.accel(i, kTrue_mps2, {}, 7);
  f.intake.log_begins();
  f.table(100, {"named"}, {{"ACCEL", 8, 0}});
  for (std::int64_t i = 100; i < 200; ++i) f.accel(i, kTwins_mps2, {}, 8);
  EXPECT_EQ(f.taken(kTrue_mps2, 2), 100);
  EXPECT_EQ(f.taken(kTwins_mps2, 2), 100);
  EXPECT_TRUE(f.notices.empty());
}

}  // namespace two_senders_test
}  // namespace framewatch::drivers
