// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/lcm/lcm_provider.h"
#include "drivers/lcm/multicast/lcm_receiver.h"

namespace framewatch::drivers {

/// A received message. Refers to memory of its source.
struct LcmMessage {
  const std::string& channel;
  const void* data = nullptr;
  std::size_t size = 0;
  std::int64_t received_us = 0;  ///< host clock
  LcmSender sender{};
};

/// Hands the messages of chosen LCM channels to one function and measures its backlog. Wait for
/// descriptor(), then call handle().
class LcmSource {
 public:
  /// Must not throw: liblcm, which is C code, calls it.
  using Handler = std::function<void(const LcmMessage& message)>;

  /// `lcm` must outlive this object. Channel names are literal. `queue_capacity` is the number of
  /// messages of each channel that may wait.
  LcmSource(LcmProvider& lcm, const std::vector<std::string>& channels, int queue_capacity,
            Handler handler);
  ~LcmSource();
  LcmSource(const LcmSource&) = delete;
  LcmSource& operator=(const LcmSource&) = delete;

  /// Waits at most `timeout_ms` for a message, then handles the waiting messages, at most
  /// queue_capacity. Returns false when LCM failed.
  [[nodiscard]] bool handle(int timeout_ms);
  /// Returns a descriptor that is readable while messages wait.
  int descriptor() const;

  /// Returns the largest number of messages that waited at once.
  std::int64_t backlog_high_water() const { return backlog_high_water_; }
  /// Returns the messages of udpm:// that were dropped; other providers drop no messages.
  ReceiverCounters dropped() const;

 private:
  bool handle_received(int timeout_ms);
  bool handle_dispatched(int timeout_ms);
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  LcmProvider& lcm_;
  std::int64_t capacity_;
  Handler handler_;
  std::unique_ptr<LcmReceiver> receiver_;  ///< null: liblcm receives
  ReceivedMessage message_;
  std::vector<lcm::Subscription*> subscriptions_;
  std::int64_t backlog_high_water_ = 0;
};

}  // namespace framewatch::drivers
