// SPDX-License-Identifier: MIT
// Datagrams of LCM's UDP multicast from several senders, and the messages joined from their parts.
#include "drivers/lcm/multicast/fragment_assembly.h"
#include "drivers/lcm/multicast/lcm_packet.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

using drivers::FragmentAssembly;

constexpr std::string_view kWantedChannel = "ACCEL";

void require_sound(const drivers::LcmPacket& packet) {
  require(packet.parts > 0 && packet.part < packet.parts, "one of the parts");
  require(std::uint64_t{packet.offset} + packet.payload.size() <= packet.message_bytes,
          "a part within its message");
  require(packet.channel.size() <= drivers::kLongestLcmChannel, "a channel of LCM's length");
  require(packet.channel.empty() == (packet.part != 0), "a channel in part 0 alone");
}

/// Reads sender and datagram, one after the other.
void receive(Bytes input) {
  Pieces pieces(input);
  FragmentAssembly assembly([](std::string_view channel) { return channel == kWantedChannel; });
  std::string channel;
  std::vector<std::uint8_t> payload;
  while (!pieces.empty()) {
    const drivers::LcmSender sender{0x7f000001, pieces.take<std::uint8_t>()};
    const std::vector<std::uint8_t> datagram = copy_of(pieces.take_block());
    const auto packet = drivers::parse_lcm_packet(datagram);
    if (!packet) continue;
    require_sound(*packet);
    if (packet->parts == 1) continue;
    const auto outcome = assembly.add(sender, *packet, channel, payload);
    require(assembly.bytes() <= FragmentAssembly::kMaxBytes, "memory that is bounded");
    require(assembly.senders() <= FragmentAssembly::kMaxSenders, "few senders");
    if (outcome != FragmentAssembly::Outcome::whole) continue;
    require(channel == kWantedChannel && payload.size() == packet->message_bytes,
            "the message that was announced");
  }
}

PiecesWriter& put_datagram(PiecesWriter& out, int sender, const std::string& datagram) {
  return out.put(static_cast<std::uint8_t>(sender))
      .put_block({reinterpret_cast<const std::uint8_t*>(datagram.data()), datagram.size()});
}

std::string big_endian(std::uint64_t value, int bytes) {
  std::string out;
  while (bytes-- > 0) out += static_cast<char>(value >> (8 * bytes));
  return out;
}

std::string short_packet(const std::string& payload) {
  return "LC02" + big_endian(7, 4) + "ACCEL" + '\0' + payload;
}

std::string long_packet(std::uint32_t size, std::uint32_t offset, int part, int parts,
                        const std::string& payload) {
  return "LC03" + big_endian(7, 4) + big_endian(size, 4) + big_endian(offset, 4) +
         big_endian(static_cast<std::uint64_t>(part), 2) +
         big_endian(static_cast<std::uint64_t>(parts), 2) +
         (part == 0 ? std::string("ACCEL") + '\0' : "") + payload;
}

std::vector<std::string> packet_seeds() {
  PiecesWriter one, in_order, backwards, two_senders, wraps;
  put_datagram(one, 1, short_packet("payload"));
  for (const int part : {0, 1, 2})
    put_datagram(in_order, 1, long_packet(12, 4 * std::uint32_t(part), part, 3, "four"));
  for (const int part : {2, 1, 0})
    put_datagram(backwards, 1, long_packet(12, 4 * std::uint32_t(part), part, 3, "four"));
  for (const int part : {0, 1})
    for (const int sender : {1, 2})
      put_datagram(two_senders, sender, long_packet(8, 4 * std::uint32_t(part), part, 2, "four"));
  put_datagram(wraps, 1, long_packet(0x1000, 0, 0, 2, "four"));
  put_datagram(wraps, 1, long_packet(0x1000, 0xffffff00, 1, 2, std::string(0x200, 'x')));
  return {one.text(), in_order.text(), backwards.text(), two_senders.text(), wraps.text()};
}

}  // namespace

const FuzzTarget kPacketTarget{"packet", &receive, &packet_seeds};

}  // namespace framewatch::test
