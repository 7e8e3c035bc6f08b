// SPDX-License-Identifier: MIT
#include "drivers/lcm/multicast/multicast_socket.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>

namespace framewatch::drivers {
namespace {

constexpr std::size_t kBatch = 32, kLongestDatagram = 65536, kControl = 256;
constexpr int kRoute = 0;  // stands for the interface that the group's route leads to

/// Returns the names from /sys: if_nameindex needs a netlink socket, which the service may not
/// open.
std::string names_of_interfaces() {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator at("/sys/class/net", error), end; !error && at != end;
       at.increment(error))
    names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Data from the kernel about a datagram.
struct Ancillary {
  int interface = 0;
  std::int64_t received_us = 0;
  std::uint32_t overflowed = 0;
};

template <typename T>
T value_of(const cmsghdr* header) {
  T value{};
  std::memcpy(&value, CMSG_DATA(header), sizeof value);
  return value;
}

Ancillary ancillary(msghdr& message) {
  Ancillary out;
  for (cmsghdr* at = CMSG_FIRSTHDR(&message); at != nullptr; at = CMSG_NXTHDR(&message, at)) {
    if (at->cmsg_level == IPPROTO_IP && at->cmsg_type == IP_PKTINFO)
      out.interface = value_of<in_pktinfo>(at).ipi_ifindex;
    if (at->cmsg_level != SOL_SOCKET) continue;
    if (at->cmsg_type == SO_RXQ_OVFL) out.overflowed = value_of<std::uint32_t>(at);
    if (at->cmsg_type == SO_TIMESTAMP) {
      const auto time = value_of<timeval>(at);
      out.received_us = std::int64_t{1'000'000} * time.tv_sec + time.tv_usec;
    }
  }
  return out;
}

bool set_option(int socket, int level, int option, int value) {
  return ::setsockopt(socket, level, option, &value, sizeof value) == 0;
}

constexpr std::int64_t kReadAgain_us = 1'000'000;
constexpr std::uint32_t kLoopback = 127;  // 127.0.0.0/8
constexpr std::size_t kMaxAddresses = 256;

}  // namespace

/// Uses ioctl: getifaddrs needs a netlink socket, which the service may not open.
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

/// Memory for one call of recvmmsg.
struct MulticastSocket::Batch {
  std::array<mmsghdr, kBatch> messages{};
  std::array<iovec, kBatch> places{};
  std::array<sockaddr_in, kBatch> senders{};
  std::array<std::array<std::uint8_t, kControl>, kBatch> controls{};
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(kBatch * kLongestDatagram);

  void prepare() {
    for (std::size_t i = 0; i < kBatch; ++i) {
      places[i] = {bytes.data() + i * kLongestDatagram, kLongestDatagram};
      messages[i] = {};
      msghdr& header = messages[i].msg_hdr;
      header.msg_name = &senders[i];
      header.msg_namelen = sizeof senders[i];
      header.msg_iov = &places[i];
      header.msg_iovlen = 1;
      header.msg_control = controls[i].data();
      header.msg_controllen = controls[i].size();
    }
  }
};

MulticastSocket::MulticastSocket() = default;
MulticastSocket::~MulticastSocket() = default;

/// Joins the group on an interface. Returns 0, also when it was joined before, or the error number.
int MulticastSocket::join(int interface) const {
  ip_mreqn request{};
  request.imr_multiaddr.s_addr = htonl(group_.address);
  request.imr_ifindex = interface;
  if (::setsockopt(socket_.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0)
    return 0;
  return errno == EADDRINUSE ? 0 : errno;
}

void MulticastSocket::join_again() {
  named_.clear();
  for (const std::string& name : group_.interfaces) {
    const int interface = static_cast<int>(::if_nametoindex(name.c_str()));
    if (interface != 0 && join(interface) == 0) named_.push_back(interface);
  }
  (void)join(kRoute);
  (void)join(static_cast<int>(::if_nametoindex("lo")));
}

bool MulticastSocket::open(const MulticastGroup& group, std::string& error) {
  group_ = group;
  socket_.reset(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int fd = socket_.get();
  (void)set_option(fd, SOL_SOCKET, SO_RCVBUF, group.receive_buffer_bytes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(group.port);
  address.sin_addr.s_addr = htonl(group.address);
  if (fd < 0 || !set_option(fd, SOL_SOCKET, SO_REUSEADDR, 1) ||
      !set_option(fd, SOL_SOCKET, SO_TIMESTAMP, 1) || !set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1) ||
      !set_option(fd, IPPROTO_IP, IP_PKTINFO, 1) ||
      !set_option(fd, IPPROTO_IP, IP_MULTICAST_ALL, 0) ||
      ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    error = std::strerror(errno);
    return false;
  }
  join_again();
  if (named_.size() == group.interfaces.size()) {
    batch_ = std::make_unique<Batch>();
    return true;
  }
  for (const std::string& name : group.interfaces) {
    const unsigned interface = ::if_nametoindex(name.c_str());
    if (interface == 0) {
      error = fmt::format("no network interface '{}'; this machine has {}", name,
                          names_of_interfaces());
      return false;
    }
    if (const int why = join(static_cast<int>(interface)); why != 0)
      error = fmt::format("interface {}: {}", name, std::strerror(why));
  }
  return false;
}

bool MulticastSocket::is_from_here(int interface, const LcmSender& sender, std::int64_t now_us) {
  return std::find(named_.begin(), named_.end(), interface) != named_.end() ||
         own_.has(sender.address, now_us);
}

bool MulticastSocket::read(const std::function<void(const Datagram&)>& take) {
  batch_->prepare();
  const int came =
      ::recvmmsg(socket_.get(), batch_->messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (came < 0) return errno == EAGAIN || errno == EINTR || errno == ENOBUFS;
  for (std::size_t i = 0; i < static_cast<std::size_t>(came); ++i) {
    msghdr& header = batch_->messages[i].msg_hdr;
    const Ancillary said = ancillary(header);
    overflowed_ += said.overflowed - std::exchange(overflowed_before_, said.overflowed);
    const sockaddr_in& from = batch_->senders[i];
    const LcmSender sender{ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)};
    if (!is_from_here(said.interface, sender, said.received_us)) {
      ++from_elsewhere_;
      continue;
    }
    take({{batch_->bytes.data() + i * kLongestDatagram, batch_->messages[i].msg_len},
          sender,
          said.received_us});
  }
  return true;
}

}  // namespace framewatch::drivers
