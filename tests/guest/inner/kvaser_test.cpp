// SPDX-License-Identifier: MIT
#include <chrono>
#include <cstdlib>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/can/can_encoder.h"
#include "tests/guest/inner/guest.h"

namespace framewatch::test {
namespace {

using Clock = std::chrono::steady_clock;

void up(const std::string& name) {
  shell("ip link set " + name + " up type can bitrate 500000 restart-ms 100");
}

/// Two PCI cards on one bus: nodes send on can1 while can0 listens, is removed from the machine
/// and inserted again.
TEST(Kvaser, SurvivesAndCountsACardThatIsRemovedAndInserted) {
  if (std::getenv("CAN_GUEST_KVASER") == nullptr) GTEST_SKIP() << "only in run-in-vm";
  constexpr int kInstants = 1200, kOut = 400, kIn = 500;
  up("can0");
  up("can1");
  const daemon::Config config = example_on("raw_int16", "can0");
  LiveBuses live(config);
  drivers::CanSocket nodes;
  std::string error;
  ASSERT_TRUE(nodes.open("can1", 4096, {{0x1FFFFFFF, 0x1FFFFFFF, true}}, false, error)) << error;
  drivers::CanEncoder encoder(config.can);
  int instant = 0;
  std::int64_t unsent = 0, before = 0;
  auto due = Clock::now();
  live.run([&] {
    while (Clock::now() >= due && instant < kInstants) {
      if (instant == kOut) shell("echo 1 > /sys/class/net/can0/device/remove");
      if (instant == kIn) {
        before = live.estimation.can().node(0).received;
        shell("echo 1 > /sys/bus/pci/rescan");
        up("can0");
      }
      for (const drivers::BusFrame& f : encoder.instant({0.001 * instant, -0.001 * instant}))
        unsent += !nodes.write(f.frame);
      ++instant;
      due += std::chrono::milliseconds(10);
    }
    return instant == kInstants;
  });
  EXPECT_EQ(live.source.state(0).downs, 1);
  EXPECT_EQ(live.source.dropped(), 0);
  std::int64_t lost = 0;
  for (std::size_t n = 0; n < 2; ++n) {
    const drivers::CanNodeCounters c = live.estimation.can().node(n);
    EXPECT_EQ(c.received + c.lost, kInstants);
    EXPECT_GT(c.lost, 0);
    EXPECT_GT(c.received, before + 300) << "did not resume";
    lost += c.lost;
  }
  fmt::print("card removed and inserted: {} frames lost, all counted, {} not sent\n", lost, unsent);
}

}  // namespace
}  // namespace framewatch::test
