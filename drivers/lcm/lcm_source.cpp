// SPDX-License-Identifier: MIT
#include "drivers/lcm/lcm_source.h"

#include <poll.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace framewatch::drivers {
namespace {

/// Returns a regular expression for exactly this channel: LCM takes channel names as regular
/// expressions.
std::string literally(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_') pattern += '\\';
    pattern += c;
  }
  return pattern;
}

}  // namespace

LcmSource::LcmSource(LcmProvider& lcm, const std::vector<std::string>& channels, int queue_capacity,
                     Handler handler)
    : lcm_(lcm), capacity_(queue_capacity), handler_(std::move(handler)) {
  if (lcm.group()) {
    receiver_ = std::make_unique<LcmReceiver>(channels, static_cast<std::size_t>(queue_capacity));
    std::string why;
    if (!receiver_->open(*lcm.group(), why)) receiver_->fail();
    return;
  }
  for (const std::string& channel : channels) {
    lcm::Subscription* subscription =
        lcm_.subscribe(literally(channel), &LcmSource::on_message, this);
    if (subscription == nullptr) continue;
    subscription->setQueueCapacity(queue_capacity);
    subscriptions_.push_back(subscription);
  }
}

LcmSource::~LcmSource() {
  for (lcm::Subscription* subscription : subscriptions_) lcm_.unsubscribe(subscription);
}

int LcmSource::descriptor() const {
  return receiver_ ? receiver_->descriptor() : lcm_.getFileno();
}

ReceiverCounters LcmSource::dropped() const {
  return receiver_ ? receiver_->counters() : ReceiverCounters{};
}

bool LcmSource::handle(int timeout_ms) {
  return receiver_ ? handle_received(timeout_ms) : handle_dispatched(timeout_ms);
}

bool LcmSource::handle_received(int timeout_ms) {
  pollfd waiting{receiver_->descriptor(), POLLIN, 0};
  if (timeout_ms != 0 && receiver_->waiting() == 0) ::poll(&waiting, 1, timeout_ms);
  backlog_high_water_ =
      std::max(backlog_high_water_, static_cast<std::int64_t>(receiver_->waiting()));
  for (std::int64_t i = 0; i < capacity_ && receiver_->take(message_); ++i)
    handler_({message_.channel, message_.payload.data(), message_.payload.size(),
              message_.received_us, message_.sender});
  return !receiver_->failed();
}

bool LcmSource::handle_dispatched(int timeout_ms) {
  int handled = lcm_.handleTimeout(timeout_ms);
  std::int64_t count = handled;
  for (; handled > 0 && count < capacity_; count += handled) handled = lcm_.handleTimeout(0);
  backlog_high_water_ = std::max(backlog_high_water_, count);
  return handled >= 0;
}

void LcmSource::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  handler_({channel, buffer->data, buffer->data_size, buffer->recv_utime, {}});
}

}  // namespace framewatch::drivers
