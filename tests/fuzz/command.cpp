// SPDX-License-Identifier: MIT
// A connection to a daemon's command socket: the packet and the command in it.
#include <framewatch/acknowledge_t.hpp>
#include <framewatch/session_command_t.hpp>

#include "daemon/monitor/service/command_client.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

void read_command(Bytes input) {
  const auto packet = daemon::packet_of(input);
  if (!packet) return;
  const std::vector<std::uint8_t> again = daemon::packet_bytes(*packet);
  require(std::equal(again.begin(), again.end(), input.begin(), input.end()), "the same packet");
  (void)drivers::decoded<acknowledge_t>(packet->bytes);
  (void)drivers::decoded<session_command_t>(packet->bytes);
}

std::vector<std::string> command_seeds() {
  std::vector<std::string> out;
  for (const daemon::CommandPacket& packet :
       {daemon::CommandPacket{"ACKNOWLEDGE", drivers::encoded(acknowledge_t{})},
        daemon::CommandPacket{"SESSION_COMMAND", drivers::encoded(session_command_t{})},
        daemon::refused("no event is raised")}) {
    const std::vector<std::uint8_t> bytes = daemon::packet_bytes(packet);
    out.emplace_back(bytes.begin(), bytes.end());
  }
  return out;
}

}  // namespace

const FuzzTarget kCommandTarget{"command", &read_command, &command_seeds};

}  // namespace framewatch::test
