// SPDX-License-Identifier: MIT
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>

#include "drivers/files/descriptor.h"
#include "tests/drivers/lcm/multicast/lcm_packets.h"

namespace framewatch::drivers {

inline constexpr const char* kTestGroup = "239.255.76.67";

/// Sends given datagrams to a multicast group over the loopback, or to one address.
class DatagramSender {
 public:
  explicit DatagramSender(std::uint16_t port, const char* address = kTestGroup)
      : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    ::inet_pton(AF_INET, address, &to_.sin_addr);
    in_addr loopback{htonl(INADDR_LOOPBACK)};
    const unsigned char ttl = 0;
    ::setsockopt(socket_.get(), IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
    ::setsockopt(socket_.get(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  void send(const packets::Bytes& datagram) const {
    (void)::sendto(socket_.get(), datagram.data(), datagram.size(), 0,
                   reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }

 private:
  Descriptor socket_;
  sockaddr_in to_{};
};

}  // namespace framewatch::drivers
