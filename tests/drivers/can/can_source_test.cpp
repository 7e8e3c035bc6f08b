// SPDX-License-Identifier: MIT
#include "drivers/can/can_source.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include <gtest/gtest.h>

#include "drivers/can/can_encoder.h"
#include "tests/support/can_traffic.h"

namespace framewatch::drivers {
namespace can_source_test {

/// A bus made of a pair of AF_UNIX sockets, which carries the frames of a raw CAN socket without
/// CAN in the kernel.
struct Harness {
  CanMap map;
  CanSocket nodes;
  std::vector<CanFrame> received;
  CanSource source;

  static CanMap one_bus() {
    CanMap map;
    map.buses.push_back({});
    return map;
  }
  Harness()
      : map(one_bus()),
        source(map, true, [this](int, const CanFrame& f) { received.push_back(f); }) {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends.data()), 0);
    const int on = 1;
    ::setsockopt(ends[1], SOL_SOCKET, SO_TIMESTAMP, &on, sizeof on);
    nodes = CanSocket(ends[0]);
    source.attach(0, ends[1]);
  }
};

CanFrame numbered(int i) {
  CanFrame f;
  f.id = static_cast<std::uint32_t>(i % 0x800);
  f.extended = i % 3 == 0;
  f.fd = i % 5 == 0;
  f.remote = !f.fd && i % 7 == 0;
  f.length = static_cast<std::uint8_t>(f.fd ? 64 : i % 9);
  if (!f.remote)
    for (std::uint8_t b = 0; b < f.length; ++b) f.data[b] = static_cast<std::uint8_t>(i + b);
  return f;
}

TEST(CanSource, ReceivesEveryKindOfFrameInOrder) {
  Harness harness;
  constexpr int kFrames = 5000;
  for (int i = 0; i < kFrames; ++i) {
    while (!harness.nodes.write(numbered(i))) harness.source.handle(i);
  }
  harness.source.handle(kFrames);
  ASSERT_EQ(harness.received.size(), static_cast<std::size_t>(kFrames));
  std::int64_t last_us = 0;
  for (int i = 0; i < kFrames; ++i) {
    const CanFrame &a = harness.received[static_cast<std::size_t>(i)], b = numbered(i);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.extended, b.extended);
    EXPECT_EQ(a.fd, b.fd);
    EXPECT_EQ(a.remote, b.remote);
    EXPECT_EQ(a.length, b.length);
    EXPECT_EQ(a.data, b.data);
    EXPECT_GE(a.stamp_us, last_us);
    last_us = a.stamp_us;
  }
  EXPECT_EQ(harness.source.dropped(), 0);
}

TEST(CanSource, SurvivesALostPeerAndOddPackets) {
  Harness harness;
  ASSERT_TRUE(harness.nodes.write(numbered(1)));
  ASSERT_EQ(::send(harness.nodes.descriptor(), "rubbish", 7, 0), 7);
  ASSERT_TRUE(harness.nodes.write(numbered(2)));
  harness.source.handle(1);
  EXPECT_EQ(harness.received.size(), 2u);
  EXPECT_TRUE(harness.source.state(0).open);
  harness.nodes = CanSocket();
  harness.source.handle(2);
  harness.source.handle(3);
  EXPECT_FALSE(harness.source.state(0).open);
  EXPECT_EQ(harness.source.state(0).downs, 1);
}

TEST(CanSource, StartsNodesThatBoot) {
  Harness harness;
  harness.map.buses[0].nmt_start = true;
  CanFrame boot;
  boot.id = 0x705;
  boot.length = 1;
  ASSERT_TRUE(harness.nodes.write(boot));
  harness.source.handle(1);
  std::vector<CanFrame> answers;
  ASSERT_EQ(harness.nodes.read(answers), CanSocket::Read::frames);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].id, 0u);
  EXPECT_EQ(answers[0].data[0], 1);
  EXPECT_EQ(answers[0].data[1], 5);
}

TEST(CanSource, RequestsOnlyItsIdsFromTheKernel) {
  CanMap map = Harness::one_bus();
  CanNodeMap node;
  node.timing = CanTiming::sync;
  node.canopen_id = 3;
  CanMessageMap message;
  message.id = 0x183;
  message.mask = 0x7FF;
  node.messages.push_back(message);
  map.nodes.push_back(node);
  std::vector<std::uint32_t> ids;
  for (const CanFilter& f : filters_of(map, 0)) ids.push_back(f.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{0x183, 0x083, 0x703, 0x080}));
}

constexpr std::int64_t kPeriod_us = 10'000;
const std::vector<std::int64_t> kSteps_us{1'000'000, -1'000'000, 3'600'000'000};

HostClockReading reading_at(std::int64_t true_us, std::int64_t step_us) {
  return {true_us + step_us, 500 + step_us, 1};
}

TEST(ContinuousStamps, RemoveClockSteps) {
  for (const std::int64_t step_us : kSteps_us) {
    ContinuousStamps stamps;
    std::int64_t day_us = test::kTrafficStart_us;
    for (int i = 0; i < 1000; ++i, day_us += kPeriod_us) {
      const bool stepped = i >= 500;
      HostClockReading reading = reading_at(day_us, stepped ? step_us : 0);
      reading.offset_us += i >= 700 ? 900 : 0;  // a change of 900 us is slewing
      stamps.now(reading);
      EXPECT_EQ(stamps.steps(), stepped) << i;
      // This frame was stamped before the step and is read after it.
      const bool old = i == 500;
      EXPECT_EQ(stamps.continuous(day_us + (stepped && !old ? step_us : 0)), day_us) << i;
    }
  }
}

TEST(ContinuousStamps, RemoveAStepWithinALongPause) {
  for (const std::int64_t step_us : kSteps_us) {
    ContinuousStamps stamps;
    std::int64_t day_us = test::kTrafficStart_us;
    stamps.now(reading_at(day_us, 0));
    EXPECT_EQ(stamps.continuous(day_us), day_us);
    for (int i = 0; i < 30; ++i) {
      day_us += 5 * kPeriod_us;
      stamps.now(reading_at(day_us, 0));
      stamps.drained();
    }
    day_us += 5 * kPeriod_us;
    stamps.now(reading_at(day_us, step_us));
    EXPECT_EQ(stamps.continuous(day_us - 100 + step_us), day_us - 100) << step_us;
    EXPECT_EQ(stamps.continuous(day_us - 50 + step_us), day_us - 50) << step_us;
  }
}

TEST(ContinuousStamps, IgnoreADoubtfulReading) {
  ContinuousStamps stamps;
  std::int64_t day_us = test::kTrafficStart_us;
  for (int i = 0; i < 100; ++i, day_us += kPeriod_us) {
    HostClockReading reading = reading_at(day_us, 0);
    if (i % 7 == 3) reading.offset_us += reading.doubtful_us = 40'000;
    stamps.now(reading);
    EXPECT_EQ(stamps.continuous(day_us), day_us);
  }
  EXPECT_EQ(stamps.steps(), 0);
}

}  // namespace can_source_test
}  // namespace framewatch::drivers
