#include "drivers/lcm/lcm_source.h"

#include <string>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace lcm_source_test {

struct Seen {
  std::vector<std::string> channels;
  LcmSource::Handler handler() {
    return [this](const std::string& channel, const void*, std::size_t, std::int64_t) {
      channels.push_back(channel);
    };
  }
};

TEST(LcmSource, HandsOverItsChannelsAndNoOthers) {
  lcm::LCM lcm("memq://");
  Seen seen;
  LcmSource source(lcm, {"ACCEL", "A.B"}, 100, seen.handler());
  for (const char* channel : {"ACCEL", "ACCEL2", "A.B", "AxB", "FRAMEWATCH_STATUS"})
    lcm.publish(channel, "x", 1);
  while (seen.channels.size() < 2 && source.handle(100)) {
  }
  EXPECT_TRUE(source.handle(0));
  EXPECT_EQ(seen.channels, (std::vector<std::string>{"ACCEL", "A.B"}));
}

TEST(LcmSource, TellsAQueueThatWasFull) {
  lcm::LCM lcm("memq://");
  Seen seen;
  LcmSource source(lcm, {"ACCEL"}, 50, seen.handler());
  EXPECT_TRUE(source.handle(0));
  for (int i = 0; i < 20; ++i) lcm.publish("ACCEL", "x", 1);
  while (seen.channels.size() < 20 && source.handle(100)) {
  }
  EXPECT_FALSE(source.queue_was_full());
  EXPECT_LE(source.backlog_high_water(), 20);
  EXPECT_TRUE(source.handle(0));
  EXPECT_EQ(source.backlog(), 0);

  int publications = 0;
  while (!source.queue_was_full() && ++publications < 1000) {
    for (int i = 0; i < 200; ++i) lcm.publish("ACCEL", "x", 1);
    EXPECT_TRUE(source.handle(100));
  }
  EXPECT_TRUE(source.queue_was_full());
  EXPECT_EQ(source.backlog_high_water(), 50);
}

TEST(LcmSource, SaysWhyLcmCannotStart) {
  std::string error;
  EXPECT_EQ(open_lcm("bogus://", 1 << 20, error), nullptr);
  EXPECT_NE(error.find("bogus://"), std::string::npos);
  EXPECT_NE(open_lcm("memq://", 1 << 20, error), nullptr);
}

}  // namespace lcm_source_test
}  // namespace framewatch::drivers
