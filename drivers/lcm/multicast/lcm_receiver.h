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

/// A message as it came over the network.
struct ReceivedMessage {
  std::string channel;
  std::vector<std::uint8_t> payload;
  std::int64_t received_us = 0;  ///< host clock
  LcmSender sender;
};

/// Datagrams, or messages, that were not taken, by reason.
struct ReceiverCounters {
  std::int64_t from_elsewhere = 0;  ///< not of this machine and not over a named interface
  std::int64_t malformed = 0;       ///< not LCM, or lengths that contradict each other
  std::int64_t unfinished = 0;      ///< messages of which a part never came
  std::int64_t overflowed = 0;      ///< dropped by the kernel: the receive buffer was full
  std::int64_t queue_full = 0;      ///< messages dropped because too many waited
  bool operator==(const ReceiverCounters&) const = default;
};

/// Receives LCM's UDP multicast in a thread of its own and keeps the messages of chosen channels
/// until they are taken. Bounded in everything: what a packet says about sizes is checked before it
/// is believed, and each channel has a queue of that capacity.
class LcmReceiver {
 public:
  LcmReceiver(std::vector<std::string> channels, std::size_t queue_capacity);
  ~LcmReceiver();
  LcmReceiver(const LcmReceiver&) = delete;
  LcmReceiver& operator=(const LcmReceiver&) = delete;

  /// False with the reason when the group cannot be heard.
  [[nodiscard]] bool open(const MulticastGroup& group, std::string& error);
  /// Readable while messages wait.
  int descriptor() const { return waiting_.get(); }
  /// The oldest message that waits; false when there is none. The memory of `message` is used
  /// again.
  [[nodiscard]] bool take(ReceivedMessage& message);
  std::size_t waiting() const;
  ReceiverCounters counters() const;
  bool failed() const { return failed_; }
  /// From now on it has failed.
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

  mutable std::mutex mutex_;                                ///< of all below it
  std::map<std::string, std::size_t, std::less<>> queued_;  ///< by channel
  std::deque<ReceivedMessage> queue_;
  std::vector<ReceivedMessage> spare_;  ///< taken ones, for their memory
  std::size_t queued_bytes_ = 0;
  ReceiverCounters counters_;

  std::atomic<bool> failed_ = false;
  std::thread thread_;
};

}  // namespace framewatch::drivers
