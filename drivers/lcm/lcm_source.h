#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

namespace framewatch::drivers {

/// An LCM instance on `url`, asking for a socket buffer of that size where the provider has one.
/// Null, with the reason and the remedy in `error`, when LCM cannot start there.
std::unique_ptr<lcm::LCM> open_lcm(const std::string& url, int receive_buffer_bytes,
                                   std::string& error);

/// Hands the raw bytes of chosen LCM channels to one function, and knows how far behind it is.
class LcmSource {
 public:
  /// `received_us`: host clock, microseconds. Must not throw: C code is underneath.
  using Handler = std::function<void(const std::string& channel, const void* data, std::size_t size,
                                     std::int64_t received_us)>;

  /// `lcm` must outlive this. Channel names are taken literally.
  LcmSource(lcm::LCM& lcm, const std::vector<std::string>& channels, int queue_capacity,
            Handler handler);
  ~LcmSource();
  LcmSource(const LcmSource&) = delete;
  LcmSource& operator=(const LcmSource&) = delete;

  /// Waits for a message at most `timeout_ms`, then handles it and those that wait behind it, at
  /// most queue_capacity. False when LCM failed.
  [[nodiscard]] bool handle(int timeout_ms);

  /// Messages handled one after the other without a wait; the queue was full when it reaches the
  /// capacity. LCM itself drops in silence: losses found then are the queue's.
  std::int64_t backlog() const { return backlog_; }
  std::int64_t backlog_high_water() const { return backlog_high_water_; }
  bool queue_was_full() const { return backlog_ >= capacity_; }

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  lcm::LCM& lcm_;
  std::int64_t capacity_;
  Handler handler_;
  std::vector<lcm::Subscription*> subscriptions_;
  std::int64_t backlog_ = 0;
  std::int64_t backlog_high_water_ = 0;
};

}  // namespace framewatch::drivers
