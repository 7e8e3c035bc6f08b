// SPDX-License-Identifier: MIT
#include "drivers/lcm/multicast/fragment_assembly.h"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/drivers/lcm/multicast/lcm_packets.h"

namespace framewatch::drivers {
namespace fragment_assembly_test {

using Outcome = FragmentAssembly::Outcome;
using packets::Bytes;
using packets::part;

class Assembly : public testing::Test {
 protected:
  Outcome add(const Bytes& datagram, const LcmSender& sender = {1, 1}) {
    const auto packet = parse_lcm_packet(datagram);
    return packet ? assembly_.add(sender, *packet, channel_, payload_) : Outcome::refused;
  }
  std::string payload() const { return {payload_.begin(), payload_.end()}; }

  FragmentAssembly assembly_{[](std::string_view channel) { return channel == "WANTED"; }};
  std::string channel_;
  std::vector<std::uint8_t> payload_;
};

const std::string kFirst("WANTED\0abc", 10);

TEST_F(Assembly, JoinsPartsInAnyOrder) {
  std::vector<Bytes> datagrams{part(1, 8, 0, 0, 3, kFirst), part(1, 8, 3, 1, 3, "de"),
                               part(1, 8, 5, 2, 3, "fgh")};
  std::vector<std::size_t> order{0, 1, 2};
  do {
    EXPECT_EQ(add(datagrams[order[0]]), Outcome::waits);
    EXPECT_EQ(add(datagrams[order[1]]), Outcome::waits);
    EXPECT_EQ(add(datagrams[order[2]]), Outcome::whole);
    EXPECT_EQ(channel_, "WANTED");
    EXPECT_EQ(payload(), "abcdefgh");
    EXPECT_EQ(assembly_.bytes(), 0u);
    EXPECT_EQ(assembly_.senders(), 0u);
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(assembly_.unfinished(), 0);
}

TEST_F(Assembly, KeepsSendersApart) {
  EXPECT_EQ(add(part(1, 6, 0, 0, 2, kFirst), {1, 1}), Outcome::waits);
  EXPECT_EQ(add(part(1, 6, 0, 0, 2, kFirst), {1, 2}), Outcome::waits);
  EXPECT_EQ(add(part(1, 6, 3, 1, 2, "xyz"), {1, 2}), Outcome::whole);
  EXPECT_EQ(payload(), "abcxyz");
  EXPECT_EQ(add(part(1, 6, 3, 1, 2, "def"), {1, 1}), Outcome::whole);
  EXPECT_EQ(payload(), "abcdef");
}

TEST_F(Assembly, DropsAnUnfinishedMessageWhenTheNextBegins) {
  EXPECT_EQ(add(part(1, 6, 0, 0, 2, kFirst)), Outcome::waits);
  EXPECT_EQ(add(part(2, 6, 0, 0, 2, kFirst)), Outcome::waits);
  EXPECT_EQ(assembly_.unfinished(), 1);
  EXPECT_EQ(add(part(2, 6, 3, 1, 2, "def")), Outcome::whole);
  EXPECT_EQ(assembly_.bytes(), 0u);
}

TEST_F(Assembly, RefusesOverlapsAndHoles) {
  EXPECT_EQ(add(part(1, 7, 0, 0, 2, kFirst)), Outcome::waits);
  EXPECT_EQ(add(part(1, 7, 4, 1, 2, "efg")), Outcome::refused);  // the fourth byte is missing
  EXPECT_EQ(add(part(2, 6, 0, 0, 2, kFirst)), Outcome::waits);
  EXPECT_EQ(add(part(2, 6, 2, 1, 2, "cdef")), Outcome::refused);  // one byte comes twice
  EXPECT_EQ(add(part(3, 6, 0, 0, 3, kFirst)), Outcome::waits);
  EXPECT_EQ(add(part(3, 6, 0, 1, 3, "abcdef")), Outcome::refused);
  EXPECT_EQ(assembly_.bytes(), 0u);
}

TEST_F(Assembly, IgnoresARepeatedPart) {
  EXPECT_EQ(add(part(1, 6, 0, 0, 2, kFirst)), Outcome::waits);
  EXPECT_EQ(add(part(1, 6, 0, 0, 2, kFirst)), Outcome::refused);
  EXPECT_EQ(add(part(1, 6, 3, 1, 2, "def")), Outcome::whole);
  EXPECT_EQ(payload(), "abcdef");
}

TEST_F(Assembly, IgnoresUnwantedChannels) {
  EXPECT_EQ(add(part(1, 200'000, 0, 0, 4, std::string("OTHER\0", 6) + std::string(60'000, 'x'))),
            Outcome::unwanted);
  EXPECT_EQ(add(part(1, 200'000, 60'000, 1, 4, std::string(60'000, 'x'))), Outcome::unwanted);
  EXPECT_EQ(assembly_.bytes(), 0u);
  EXPECT_EQ(add(part(2, 200'000, 60'000, 1, 4, "y")),
            Outcome::waits);  // the sender is not known yet
  EXPECT_EQ(add(part(2, 200'000, 0, 0, 4, std::string("OTHER\0", 6))), Outcome::unwanted);
  EXPECT_EQ(assembly_.bytes(), 0u);
  EXPECT_EQ(assembly_.unfinished(), 0);
}

TEST_F(Assembly, TakesMemoryOnlyForReceivedBytes) {
  EXPECT_EQ(add(part(1, 1u << 28, 0, 0, 65535, kFirst)), Outcome::refused);
  EXPECT_EQ(add(part(2, FragmentAssembly::kMaxMessageBytes, 0, 0, 65535, kFirst)), Outcome::waits);
  EXPECT_LT(assembly_.bytes(), 1000u);
}

TEST_F(Assembly, IsBoundedForAnyInput) {
  std::mt19937 random(2);
  const std::string body(60'000, 'x');
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const LcmSender sender{i % 700, 1};
    (void)add(part(1, FragmentAssembly::kMaxMessageBytes,
                   static_cast<std::uint32_t>(random() % (15u << 20)), i % 65535, 65535,
                   i % 65535 == 0 ? kFirst : body),
              sender);
    ASSERT_LE(assembly_.bytes(), FragmentAssembly::kMaxBytes);
    ASSERT_LE(assembly_.senders(), FragmentAssembly::kMaxSenders);
  }
  EXPECT_GT(assembly_.unfinished(), 0);
}

}  // namespace fragment_assembly_test
}  // namespace framewatch::drivers
