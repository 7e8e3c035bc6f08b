#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace framewatch::daemon {

/// raw: samples and their tables; frame: of a CAN bus; estimate: what the estimator says.
enum class MessageKind { raw, frame, estimate };

/// A message as it was received; a CAN frame as a line of candump.
struct KeptMessage {
  MessageKind kind;
  std::int64_t received_us;  ///< host clock
  std::string channel;
  std::string bytes;
};

/// Keeps the messages of the last seconds, for the time before a trigger. Bounded in time and
/// bytes.
class MessageRing {
 public:
  MessageRing(double seconds, std::size_t bytes)
      : span_us_(static_cast<std::int64_t>(1e6 * seconds)), most_bytes_(bytes) {}

  void push(KeptMessage message);
  const std::deque<KeptMessage>& messages() const { return messages_; }
  void clear();

 private:
  static std::size_t cost(const KeptMessage& message);
  void drop_oldest();

  std::int64_t span_us_;
  std::size_t most_bytes_, bytes_ = 0;
  std::deque<KeptMessage> messages_;
};

}  // namespace framewatch::daemon
