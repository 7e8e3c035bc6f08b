#include "daemon/tools/session/message_ring.h"

#include <utility>

namespace framewatch::daemon {

std::size_t MessageRing::cost(const KeptMessage& message) {
  return sizeof message + message.channel.size() + message.bytes.size();
}

void MessageRing::push(KeptMessage message) {
  const std::int64_t oldest_us = message.received_us - span_us_;
  bytes_ += cost(message);
  messages_.push_back(std::move(message));
  while (!messages_.empty() && (bytes_ > most_bytes_ || messages_.front().received_us < oldest_us))
    drop_oldest();
}

void MessageRing::drop_oldest() {
  bytes_ -= cost(messages_.front());
  messages_.pop_front();
}

void MessageRing::clear() {
  messages_.clear();
  bytes_ = 0;
}

}  // namespace framewatch::daemon
