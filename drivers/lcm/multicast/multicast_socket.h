#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/files/descriptor.h"
#include "drivers/lcm/multicast/lcm_sender.h"
#include "drivers/lcm/multicast/own_addresses.h"

namespace framewatch::drivers {

/// A group, and from where its datagrams are taken.
struct MulticastGroup {
  std::uint32_t address = 0;  ///< host byte order
  std::uint16_t port = 0;
  /// Datagrams that come over these are taken, whoever sent them. This machine's own are always.
  std::vector<std::string> interfaces{"lo"};
  int receive_buffer_bytes = 4194304;
};

struct Datagram {
  std::span<const std::uint8_t> bytes;
  LcmSender sender;
  std::int64_t received_us = 0;  ///< host clock, by the kernel
};

/// A socket that hears one multicast group and nothing else: it is bound to the group's address, so
/// unicast does not reach it, and joins the group on chosen interfaces only.
class MulticastSocket {
 public:
  MulticastSocket();
  ~MulticastSocket();
  MulticastSocket(const MulticastSocket&) = delete;
  MulticastSocket& operator=(const MulticastSocket&) = delete;

  /// False with the reason.
  [[nodiscard]] bool open(const MulticastGroup& group, std::string& error);
  int descriptor() const { return socket_.get(); }

  /// Hands over datagrams that wait, at most a batch. False when the socket failed.
  [[nodiscard]] bool read(const std::function<void(const Datagram&)>& take);
  /// Joins again where an interface has gone and come back, or the group's route has changed.
  void join_again();

  std::int64_t from_elsewhere() const { return from_elsewhere_; }  ///< datagrams not taken
  /// Datagrams that the kernel dropped because the receive buffer was full.
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
