// SPDX-License-Identifier: MIT
#include "drivers/lcm/lcm_source.h"

#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace lcm_source_test {

struct Seen {
  std::vector<std::string> channels;
  LcmSource::Handler handler() {
    return [this](const LcmMessage& message) { channels.push_back(message.channel); };
  }
};

/// Returns the messages received when messages come on these channels and two of them are wanted.
std::vector<std::string> heard(LcmProvider& lcm) {
  Seen seen;
  LcmSource source(lcm, {"ACCEL", "A.B"}, 100, seen.handler());
  for (const char* channel : {"ACCEL", "ACCEL2", "A.B", "AxB", "FRAMEWATCH_STATUS"})
    lcm.publish(channel, "x", 1);
  while (seen.channels.size() < 2 && source.handle(30'000)) {
  }
  EXPECT_TRUE(source.handle(0));
  return seen.channels;
}

const std::vector<std::string> kWanted{"ACCEL", "A.B"};

TEST(LcmSource, DeliversOnlyItsChannels) {
  LcmProvider lcm("memq://");
  EXPECT_FALSE(lcm.group());
  EXPECT_EQ(heard(lcm), kWanted);
}

TEST(LcmSource, DeliversOnlyItsChannelsOverMulticast) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::string error;
  const auto lcm = open_lcm("udpm://239.255.76.67:7713?ttl=0", {}, error);
  ASSERT_TRUE(lcm) << error;
  ASSERT_TRUE(lcm->group());
  EXPECT_EQ(lcm->group()->port, 7713);
  EXPECT_EQ(heard(*lcm), kWanted);
}

TEST(LcmSource, CountsWaitingMessages) {
  LcmProvider lcm("memq://");
  Seen seen;
  LcmSource source(lcm, {"ACCEL"}, 50, seen.handler());
  EXPECT_TRUE(source.handle(0));
  for (int i = 0; i < 20; ++i) lcm.publish("ACCEL", "x", 1);
  while (seen.channels.size() < 20 && source.handle(100)) {
  }
  EXPECT_EQ(seen.channels.size(), 20u);
  EXPECT_GT(source.backlog_high_water(), 0);
  EXPECT_LE(source.backlog_high_water(), 20);
}

TEST(OpenLcm, ReportsWhyLcmCannotStart) {
  std::string error;
  EXPECT_EQ(open_lcm("bogus://", {}, error), nullptr);
  EXPECT_NE(error.find("bogus://"), std::string::npos);
  EXPECT_NE(open_lcm("memq://", {}, error), nullptr);
  for (const char* url : {"udpm://10.0.0.1:7667", "udpm://239.255.76.67:0", "udpm://nowhere:7667",
                          "udpm://239.255.76.67:99999"}) {
    EXPECT_EQ(open_lcm(url, {}, error), nullptr) << url;
    EXPECT_NE(error.find("expected a multicast address"), std::string::npos) << error;
  }
}

TEST(OpenLcm, ListsTheInterfaces) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::string error;
  EXPECT_EQ(open_lcm("udpm://?ttl=0", {{"eth77"}, 1 << 20}, error), nullptr);
  EXPECT_NE(error.find("no network interface 'eth77'"), std::string::npos) << error;
}

}  // namespace lcm_source_test
}  // namespace framewatch::drivers
