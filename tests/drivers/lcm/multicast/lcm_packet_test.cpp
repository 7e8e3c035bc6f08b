// SPDX-License-Identifier: MIT
#include "drivers/lcm/multicast/lcm_packet.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/drivers/lcm/multicast/lcm_packets.h"

namespace framewatch::drivers {
namespace lcm_packet_test {

using packets::Bytes;
using packets::part;
using packets::whole;

std::string text(const LcmPacket& packet) {
  return {packet.payload.begin(), packet.payload.end()};
}

TEST(LcmPacket, ReadsAWholeMessage) {
  const Bytes bytes = whole(7, "ACCEL", "payload");
  const auto packet = parse_lcm_packet(bytes);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->sequence, 7u);
  EXPECT_EQ(packet->channel, "ACCEL");
  EXPECT_EQ(text(*packet), "payload");
  EXPECT_EQ(packet->message_bytes, 7u);
  EXPECT_EQ(packet->parts, 1);
}

TEST(LcmPacket, ReadsEveryPartOfAMessage) {
  const Bytes first = part(9, 3000, 0, 0, 3, std::string("ACCEL\0abc", 9));
  const Bytes second = part(9, 3000, 3, 1, 3, "defg");
  const auto a = parse_lcm_packet(first), b = parse_lcm_packet(second);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->channel, "ACCEL");
  EXPECT_EQ(text(*a), "abc");
  EXPECT_EQ(b->channel, "");
  EXPECT_EQ(b->offset, 3u);
  EXPECT_EQ(b->part, 1);
  EXPECT_EQ(b->parts, 3);
  EXPECT_EQ(text(*b), "defg");
}

TEST(LcmPacket, RefusesNamesWithoutAnEnd) {
  EXPECT_FALSE(parse_lcm_packet(whole(5, "", "x")));
  EXPECT_FALSE(parse_lcm_packet(whole(5, std::string(kLongestLcmChannel + 1, 'a'), "x")));
  EXPECT_TRUE(parse_lcm_packet(whole(5, std::string(kLongestLcmChannel, 'a'), "x")));
  Bytes cut = whole(5, "ACCEL", "");
  cut.pop_back();  // the NUL
  EXPECT_FALSE(parse_lcm_packet(cut));
  EXPECT_FALSE(parse_lcm_packet(part(9, 10, 0, 0, 1, "ACCEL")));
}

TEST(LcmPacket, RefusesPartsThatLieOutsideTheirMessage) {
  EXPECT_FALSE(parse_lcm_packet(part(77, 3000, 0xFFFFFF00, 1, 3, std::string(0x200, 'B'))));
  EXPECT_FALSE(parse_lcm_packet(part(77, 3000, 2999, 1, 3, "ab")));
  EXPECT_TRUE(parse_lcm_packet(part(77, 3000, 2999, 1, 3, "a")));
  EXPECT_FALSE(parse_lcm_packet(part(77, 3000, 3001, 1, 3, "")));
  EXPECT_FALSE(parse_lcm_packet(part(77, 3000, 0, 3, 3, "a")));
  EXPECT_FALSE(parse_lcm_packet(part(77, 3000, 0, 0, 0, std::string("A\0a", 3))));
}

TEST(LcmPacket, RefusesTruncatedAndForeignPackets) {
  for (const Bytes& bytes : {whole(1, "ACCEL", ""), part(9, 30, 0, 0, 3, std::string("ACCEL\0", 6)),
                             part(9, 30, 3, 1, 3, "")}) {
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_FALSE(parse_lcm_packet(std::span(bytes).first(size))) << size;
    EXPECT_TRUE(parse_lcm_packet(bytes));
  }
  Bytes foreign = whole(1, "ACCEL", "x");
  foreign[0] = 'M';
  EXPECT_FALSE(parse_lcm_packet(foreign));
}

TEST(LcmPacket, NeverReadsBeyondItsBytes) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200'000; ++trial) {
    Bytes bytes = trial % 2 == 0 ? whole(1, "ACCEL", "some payload")
                                 : part(9, 30, 3, trial % 3, 3, std::string("A\0defg", 6));
    for (int flips = 1 + trial % 4; flips > 0; --flips)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    const auto packet = parse_lcm_packet(bytes);
    if (!packet) continue;
    ASSERT_GE(packet->payload.data(), bytes.data());
    ASSERT_LE(packet->payload.data() + packet->payload.size(), bytes.data() + bytes.size());
    ASSERT_LE(std::uint64_t{packet->offset} + packet->payload.size(), packet->message_bytes);
    ASSERT_LT(packet->part, packet->parts);
  }
}

}  // namespace lcm_packet_test
}  // namespace framewatch::drivers
