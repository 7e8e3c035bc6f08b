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

/// A message that has come. Refers to memory that is its giver's.
struct LcmMessage {
  const std::string& channel;
  const void* data = nullptr;
  std::size_t size = 0;
  std::int64_t received_us = 0;  ///< host clock
  LcmSender sender{};
};

/// Hands the messages of chosen LCM channels to one function, and knows how far behind it is.
class LcmSource {
 public:
  /// Must not throw: C code is underneath.
  using Handler = std::function<void(const LcmMessage& message)>;

  /// `lcm` must outlive this. Channel names are taken literally. queue_capacity: messages of each
  /// channel that may wait.
  LcmSource(LcmProvider& lcm, const std::vector<std::string>& channels, int queue_capacity,
            Handler handler);
  ~LcmSource();
  LcmSource(const LcmSource&) = delete;
  LcmSource& operator=(const LcmSource&) = delete;

  /// Waits for a message at most `timeout_ms`, then handles it and those that wait behind it, at
  /// most queue_capacity. False when LCM failed.
  [[nodiscard]] bool handle(int timeout_ms);
  /// Readable while messages wait.
  int descriptor() const;

  std::int64_t backlog_high_water() const { return backlog_high_water_; }
  /// What did not come this far, of udpm://; other providers drop nothing.
  ReceiverCounters dropped() const;

 private:
  bool handle_received(int timeout_ms);
  bool handle_dispatched(int timeout_ms);
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  LcmProvider& lcm_;
  std::int64_t capacity_;
  Handler handler_;
  std::unique_ptr<LcmReceiver> receiver_;  ///< null: liblcm dispatches
  ReceivedMessage message_;
  std::vector<lcm::Subscription*> subscriptions_;
  std::int64_t backlog_high_water_ = 0;
};

}  // namespace framewatch::drivers
