// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/files/descriptor.h"
#include "drivers/lcm/multicast/fragment_assembly.h"
#include "drivers/lcm/multicast/multicast_socket.h"

namespace framewatch::drivers {

/// A message received over the network.
struct ReceivedMessage {
  std::string channel;
  std::vector<std::uint8_t> payload;
  std::int64_t received_us = 0;  ///< host clock
  LcmSender sender;
};

/// Counts datagrams and messages that were not delivered, by reason.
struct ReceiverCounters {
  std::int64_t from_elsewhere = 0;  ///< not from this machine and not over a chosen interface
  std::int64_t malformed = 0;       ///< not LCM, or with contradictory lengths
  std::int64_t unfinished = 0;      ///< messages with a missing part
  std::int64_t overflowed = 0;      ///< dropped by the kernel: the receive buffer was full
  std::int64_t queue_full = 0;      ///< messages dropped because too many waited
  bool operator==(const ReceiverCounters&) const = default;
};

/// Receives LCM's UDP multicast in a separate thread and queues the messages of chosen channels
/// until take(). Checks the sizes that packets claim and bounds all memory; each channel has a
/// queue of limited capacity.
class LcmReceiver {
 public:
  /// `queue_capacity` is the number of messages of each channel that may wait.
  LcmReceiver(std::vector<std::string> channels, std::size_t queue_capacity);
  ~LcmReceiver();
  LcmReceiver(const LcmReceiver&) = delete;
  LcmReceiver& operator=(const LcmReceiver&) = delete;

  /// Joins the group and starts the thread. Returns false and sets `error` when that fails.
  [[nodiscard]] bool open(const MulticastGroup& group, std::string& error);
  /// Returns a descriptor that is readable while messages wait.
  int descriptor() const { return waiting_.get(); }
  /// Moves the oldest waiting message to `message` and reuses the memory of the message before.
  /// Returns false when no message waits.
  [[nodiscard]] bool take(ReceivedMessage& message);
  /// Returns the number of waiting messages.
  std::size_t waiting() const;
  ReceiverCounters counters() const;
  bool failed() const { return failed_; }
  /// Makes failed() true.
  void fail() { failed_ = true; }

 private:
  static constexpr std::size_t kMaxQueuedBytes = std::size_t{128} << 20;

  void work();
  void datagram(const Datagram& datagram);
  void queue(std::string_view channel, std::span<const std::uint8_t> payload,
             const Datagram& datagram);

  const std::size_t capacity_;
  MulticastSocket socket_;
  FragmentAssembly assembly_;
  std::string joined_channel_;
  std::vector<std::uint8_t> joined_payload_;
  Descriptor waiting_, stop_;

  mutable std::mutex mutex_;                                ///< guards the members below
  std::map<std::string, std::size_t, std::less<>> queued_;  ///< waiting messages by channel
  std::deque<ReceivedMessage> queue_;
  std::vector<ReceivedMessage> spare_;  ///< messages kept for their memory
  std::size_t queued_bytes_ = 0;
  ReceiverCounters counters_;

  std::atomic<bool> failed_ = false;
  std::thread thread_;
};

}  // namespace framewatch::drivers
