#include "drivers/lcm/multicast/own_addresses.h"

#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <cstring>

#include "drivers/files/descriptor.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kReadAgain_us = 1'000'000;
constexpr std::uint32_t kLoopback = 127;  // 127.0.0.0/8
constexpr std::size_t kMaxAddresses = 256;

}  // namespace

/// By ioctl: getifaddrs needs a netlink socket, which the service may not open.
void OwnAddresses::read() {
  std::array<ifreq, kMaxAddresses> all{};
  ifconf request{};
  request.ifc_len = static_cast<int>(sizeof all);
  request.ifc_req = all.data();
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (::ioctl(socket.get(), SIOCGIFCONF, &request) != 0) return;
  addresses_.clear();
  const std::size_t count = static_cast<std::size_t>(request.ifc_len) / sizeof(ifreq);
  for (std::size_t i = 0; i < count; ++i) {
    sockaddr_in address{};
    std::memcpy(&address, &all[i].ifr_addr, sizeof address);
    addresses_.insert(ntohl(address.sin_addr.s_addr));
  }
}

bool OwnAddresses::has(std::uint32_t address, std::int64_t now_us) {
  if (address >> 24 == kLoopback || addresses_.contains(address)) return true;
  if (std::abs(now_us - read_us_) < kReadAgain_us) return false;
  read_us_ = now_us;
  read();
  return addresses_.contains(address);
}

}  // namespace framewatch::drivers
