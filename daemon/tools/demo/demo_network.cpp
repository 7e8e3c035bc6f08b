// SPDX-License-Identifier: MIT
#include "daemon/tools/demo/demo_network.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/core.h>

#include "drivers/files/descriptor.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kGroup = "239.255.76.67";

void set_address(sockaddr& out, const char* address) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  ::inet_pton(AF_INET, address, &in.sin_addr);
  std::memcpy(&out, &in, sizeof in);
}

drivers::Descriptor datagram_socket() {
  return drivers::Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
}

bool bring_loopback_up(int fd) {
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0) return false;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_RUNNING);
  return ::ioctl(fd, SIOCSIFFLAGS, &request) == 0;
}

bool add_multicast_route(int fd) {
  rtentry route{};
  set_address(route.rt_dst, kGroup);
  set_address(route.rt_genmask, "255.255.255.255");
  route.rt_flags = RTF_UP | RTF_HOST;
  char device[] = "lo";
  route.rt_dev = device;
  return ::ioctl(fd, SIOCADDRT, &route) == 0;
}

/// Maps the user to itself, so that files keep their owner.
void keep_user(uid_t user, gid_t group) {
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << fmt::format("{} {} 1", user, user);
  std::ofstream("/proc/self/gid_map") << fmt::format("{} {} 1", group, group);
}

/// Checked before starting LCM, which prints a page of advice without a route.
bool has_multicast_route() {
  const drivers::Descriptor socket = datagram_socket();
  sockaddr group{};
  set_address(group, kGroup);
  return ::connect(socket.get(), &group, sizeof group) == 0;
}

/// Moves this single-threaded process into a private user and network namespace with a multicast
/// route on the loopback. Returns false and sets the error if the kernel refuses.
bool enter_private_network(std::string& error) {
  const uid_t user = ::getuid();
  const gid_t group = ::getgid();
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0) {
    keep_user(user, group);
  } else if (::unshare(CLONE_NEWNET) != 0) {
    error = std::strerror(errno);
    return false;
  }
  const drivers::Descriptor socket = datagram_socket();
  if (bring_loopback_up(socket.get()) && add_multicast_route(socket.get())) return true;
  error = std::strerror(errno);
  return false;
}

/// Returns true if a message sent on `url` comes back within a second.
bool lcm_round_trip(const std::string& url) {
  std::string error;
  const auto lcm = drivers::open_lcm(url, {}, error);
  if (!lcm) return false;
  const std::string channel = fmt::format("FRAMEWATCH_PROBE_{}", ::getpid());
  int received = 0;
  drivers::LcmSource source(*lcm, {channel}, 10, [&](const auto&) { ++received; });
  const char byte = 0;
  for (int attempt = 0; attempt < 5 && received == 0; ++attempt) {
    if (lcm->publish(channel, &byte, 1) != 0 || !source.handle(200)) return false;
  }
  return received > 0;
}

}  // namespace

DemoNetwork open_demo_network(int port) {
  const std::string url = fmt::format("udpm://{}:{}?ttl=0", kGroup, port);
  if (has_multicast_route() && lcm_round_trip(url))
    return {url, false, "LCM over UDP multicast that stays on this machine (ttl 0)"};
  std::string error;
  if (enter_private_network(error) && lcm_round_trip(url))
    return {url, false,
            "LCM over UDP multicast in a private network namespace, because this machine has no "
            "multicast route"};
  return {"memq://", true,
          fmt::format("LCM inside one process (memq): this machine has no multicast route and "
                      "allows no network namespace{}",
                      error.empty() ? "" : " (" + error + ")")};
}

}  // namespace framewatch::daemon
