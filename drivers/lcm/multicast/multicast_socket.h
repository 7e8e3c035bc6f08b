// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "drivers/files/descriptor.h"
#include "drivers/lcm/multicast/lcm_packet.h"

namespace framewatch::drivers {

/// Knows the IPv4 addresses of this machine. Linux refuses packets from outside that claim one of
/// them.
class OwnAddresses {
 public:
  OwnAddresses() { read(); }
  /// Returns true for an address of this machine. `address` is in host byte order. `now_us` is any
  /// clock; new addresses are found within a second.
  bool has(std::uint32_t address, std::int64_t now_us);

 private:
  void read();

  std::set<std::uint32_t> addresses_;
  std::int64_t read_us_ = 0;
};

/// A multicast group and the interfaces whose datagrams are accepted.
struct MulticastGroup {
  std::uint32_t address = 0;  ///< host byte order
  std::uint16_t port = 0;
  /// Datagrams over these interfaces are accepted from any sender; those of this machine always
  /// are.
  std::vector<std::string> interfaces{"lo"};
  int receive_buffer_bytes = 4194304;
};

/// A datagram; `bytes` belong to the socket.
struct Datagram {
  std::span<const std::uint8_t> bytes;
  LcmSender sender;
  std::int64_t received_us = 0;  ///< host clock, by the kernel
};

/// Receives one multicast group and nothing else: the socket is bound to the address of the group,
/// so that unicast does not reach it, and joins the group on chosen interfaces only.
class MulticastSocket {
 public:
  MulticastSocket();
  ~MulticastSocket();
  MulticastSocket(const MulticastSocket&) = delete;
  MulticastSocket& operator=(const MulticastSocket&) = delete;

  /// Opens the socket. Returns false and sets `error` when the group cannot be joined.
  [[nodiscard]] bool open(const MulticastGroup& group, std::string& error);
  int descriptor() const { return socket_.get(); }

  /// Calls `take` for the waiting datagrams, at most 32. Returns false when the socket failed.
  [[nodiscard]] bool read(const std::function<void(const Datagram&)>& take);
  /// Joins the group again, for interfaces that came back and for changed routes. Call it every few
  /// seconds.
  void join_again();

  std::int64_t from_elsewhere() const { return from_elsewhere_; }  ///< datagrams rejected
  /// Returns the datagrams that the kernel dropped because the receive buffer was full.
  std::int64_t overflowed() const { return overflowed_; }

 private:
  struct Batch;
  bool is_from_here(int interface, const LcmSender& sender, std::int64_t now_us);
  int join(int interface) const;

  MulticastGroup group_;
  Descriptor socket_;
  std::vector<int> named_;  ///< numbers of the named interfaces
  OwnAddresses own_;
  std::unique_ptr<Batch> batch_;
  std::uint32_t overflowed_before_ = 0;
  std::int64_t from_elsewhere_ = 0, overflowed_ = 0;
};

}  // namespace framewatch::drivers
