// SPDX-License-Identifier: MIT
#include "drivers/lcm/accel_intake.h"

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace bound_sender_test {

constexpr LcmSender kNode{0x7F000001, 40000}, kNodeAnew{0x7F000001, 40001}, kTwin{0x0A000002, 9};

TEST(LcmSender, IsPrintedAsAddressAndPort) {
  EXPECT_EQ(to_text(kTwin), "10.0.0.2:9");
  EXPECT_EQ(to_text({0xFFFFFFFF, 65535}), "255.255.255.255:65535");
}

TEST(BoundSender, KeepsTheFirstSender) {
  BoundSender sender;
  for (std::int64_t t = 0; t < 10'000'000; t += 10'000) {
    EXPECT_TRUE(sender.takes(kNode, t));
    EXPECT_FALSE(sender.takes(kTwin, t + 1));
    EXPECT_EQ(sender.contested(t + 2), t > 0);
  }
  EXPECT_EQ(sender.others, 1000);
  EXPECT_EQ(sender.contests, 999);
  EXPECT_EQ(sender.bound(), kNode);
  EXPECT_EQ(sender.other(), kTwin);
}

TEST(BoundSender, ARestartedNodeTakesOverWithoutAContest) {
  BoundSender sender;
  EXPECT_TRUE(sender.takes(kNode, 0));
  std::int64_t left_out = 0;
  for (std::int64_t t = 500'000; t < 4'000'000; t += 10'000)
    left_out += !sender.takes(kNodeAnew, t);
  EXPECT_EQ(left_out, 151);  // until the old address is silent for 2 s
  EXPECT_EQ(sender.contests, 0);
  EXPECT_FALSE(sender.takes(kNode, 4'000'000));
}

TEST(BoundSender, TakesEveryMessageWithoutAnAddress) {
  BoundSender sender;
  for (std::int64_t t = 0; t < 100; ++t) EXPECT_TRUE(sender.takes({}, t));
  EXPECT_EQ(sender.others + sender.contests, 0);
}

TEST(BoundSender, AcceptsASenderAgainAfterAClockIsSetBack) {
  BoundSender sender;
  EXPECT_TRUE(sender.takes(kNode, 3'600'000'000));
  EXPECT_FALSE(sender.takes(kNodeAnew, 0));
  EXPECT_TRUE(sender.takes(kNodeAnew, 2'000'001));
}

}  // namespace bound_sender_test
}  // namespace framewatch::drivers
