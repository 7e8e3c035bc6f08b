// SPDX-License-Identifier: MIT
#include "drivers/can/can_socket.h"

#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace framewatch::drivers {
namespace {

constexpr std::size_t kBatch = 64;
constexpr std::size_t kControl = 256;
/// The controller's clock was reset when its stamp is farther than this from the kernel's.
constexpr double kControllerJump_us = 50'000;

std::int64_t microseconds(const timespec& t) {
  return std::int64_t{1'000'000} * t.tv_sec + t.tv_nsec / 1000;
}

std::int64_t host_clock_us() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return microseconds(now);
}

CanFrame converted(const canfd_frame& raw, std::size_t bytes) {
  CanFrame out;
  out.fd = bytes == CANFD_MTU;
  out.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  out.extended = !out.error && (raw.can_id & CAN_EFF_FLAG) != 0;
  out.remote = !out.fd && (raw.can_id & CAN_RTR_FLAG) != 0;
  out.id = raw.can_id & (out.error ? CAN_ERR_MASK : out.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  out.bit_rate_switch = out.fd && (raw.flags & CANFD_BRS) != 0;
  out.length = std::min<std::uint8_t>(raw.len, out.fd ? 64 : 8);
  if (!out.remote) std::copy_n(raw.data, out.length, out.data.begin());
  return out;
}

}  // namespace

bool CanSocket::open(const std::string& interface, int receive_buffer_bytes,
                     const std::vector<CanFilter>& filters, bool own_frames, std::string& error) {
  const auto fail = [&](const char* what) {
    error = interface + ": " + what + ": " + std::strerror(errno);
    return false;
  };
  CanSocket made(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (made.descriptor() < 0) return fail("this kernel has no raw CAN sockets");
  made.index_ = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (made.index_ == 0) return fail("no such interface");
  const auto set = [&](int level, int option, int value) {
    return ::setsockopt(made.descriptor(), level, option, &value, sizeof value) == 0;
  };
  if (filters.size() <= CAN_RAW_FILTER_MAX && !filters.empty()) {
    std::vector<can_filter> wanted;
    for (const CanFilter& f : filters)
      wanted.push_back({f.id | (f.extended ? CAN_EFF_FLAG : 0), f.mask | CAN_EFF_FLAG});
    if (::setsockopt(made.descriptor(), SOL_CAN_RAW, CAN_RAW_FILTER, wanted.data(),
                     static_cast<socklen_t>(wanted.size() * sizeof(can_filter))) != 0)
      return fail("the kernel refuses the filters");
  }
  (void)set(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, static_cast<int>(CAN_ERR_MASK));
  (void)set(SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1);
  if (own_frames) (void)set(SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1);
  if (!set(SOL_SOCKET, SO_RCVBUFFORCE, receive_buffer_bytes))
    (void)set(SOL_SOCKET, SO_RCVBUF, receive_buffer_bytes);
  socklen_t size = sizeof made.buffer_bytes_;
  ::getsockopt(made.descriptor(), SOL_SOCKET, SO_RCVBUF, &made.buffer_bytes_, &size);
  made.buffer_bytes_ /= 2;  // the kernel reports twice the size
  (void)set(SOL_SOCKET, SO_RXQ_OVFL, 1);
  if (!set(SOL_SOCKET, SO_TIMESTAMPING,
           SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_RX_SOFTWARE |
               SOF_TIMESTAMPING_RAW_HARDWARE | SOF_TIMESTAMPING_RX_HARDWARE))
    return fail("the kernel gives no receive stamps");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = made.index_;
  if (::bind(made.descriptor(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return fail("cannot bind");
  *this = std::move(made);
  return true;
}

std::int64_t CanSocket::stamp_us(const void* message) {
  const auto* header = static_cast<const msghdr*>(message);
  std::int64_t kernel_us = 0, controller_us = 0;
  for (cmsghdr* c = CMSG_FIRSTHDR(header); c != nullptr;
       c = CMSG_NXTHDR(const_cast<msghdr*>(header), c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t total = 0;
      std::memcpy(&total, CMSG_DATA(c), sizeof total);
      dropped_ += static_cast<std::uint32_t>(total - dropped_before_);
      dropped_before_ = total;
    } else if (c->cmsg_type == SCM_TIMESTAMPING) {
      scm_timestamping stamps{};
      std::memcpy(&stamps, CMSG_DATA(c), sizeof stamps);
      kernel_us = microseconds(stamps.ts[0]);
      controller_us = microseconds(stamps.ts[2]);
    } else if (c->cmsg_type == SCM_TIMESTAMP) {
      timeval stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      kernel_us = std::int64_t{1'000'000} * stamp.tv_sec + stamp.tv_usec;
    }
  }
  if (kernel_us == 0) kernel_us = host_clock_us();
  if (controller_us == 0) return kernel_us;
  const auto device = static_cast<double>(controller_us), host = static_cast<double>(kernel_us);
  if (!controller_.started() || std::abs(host - controller_.host_us(device)) > kControllerJump_us)
    controller_.start(device, host);
  controller_.add(device, host);
  return std::llround(controller_.host_us(device));
}

CanSocket::Read CanSocket::read(std::vector<CanFrame>& frames) {
  frames.clear();
  std::array<canfd_frame, kBatch> raw;
  std::array<iovec, kBatch> place;
  alignas(cmsghdr) std::array<std::array<char, kControl>, kBatch> control;
  std::array<mmsghdr, kBatch> messages{};
  for (std::size_t i = 0; i < kBatch; ++i) {
    place[i] = {&raw[i], sizeof raw[i]};
    messages[i].msg_hdr.msg_iov = &place[i];
    messages[i].msg_hdr.msg_iovlen = 1;
    messages[i].msg_hdr.msg_control = control[i].data();
    messages[i].msg_hdr.msg_controllen = kControl;
  }
  const int count = ::recvmmsg(fd_.get(), messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (count < 0) {
    if (errno == EAGAIN || errno == EINTR || errno == ENOBUFS) return Read::idle;
    return errno == ENETDOWN ? Read::down : Read::failed;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (messages[i].msg_len == 0) return frames.empty() ? Read::failed : Read::frames;
    if (messages[i].msg_len != CAN_MTU && messages[i].msg_len != CANFD_MTU) continue;
    frames.push_back(converted(raw[i], messages[i].msg_len));
    frames.back().stamp_us = stamp_us(&messages[i].msg_hdr);
  }
  return count == 0 ? Read::failed : Read::frames;
}

bool CanSocket::write(const CanFrame& frame) const {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0) | (frame.remote ? CAN_RTR_FLAG : 0) |
               (frame.error ? CAN_ERR_FLAG : 0);
  raw.len = frame.length;
  if (frame.bit_rate_switch) raw.flags = CANFD_BRS;
  std::copy_n(frame.data.begin(), frame.length, raw.data);
  const std::size_t bytes = frame.fd ? CANFD_MTU : CAN_MTU;
  return ::send(fd_.get(), &raw, bytes, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(bytes);
}

int find_interface(const std::string& name, bool& up) {
  up = false;
  Descriptor any(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (any.get() < 0) any.reset(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  std::strncpy(request.ifr_name, name.c_str(), IFNAMSIZ - 1);
  if (::ioctl(any.get(), SIOCGIFFLAGS, &request) != 0) return 0;
  up = (request.ifr_flags & IFF_UP) != 0;
  return static_cast<int>(::if_nametoindex(name.c_str()));
}

}  // namespace framewatch::drivers
