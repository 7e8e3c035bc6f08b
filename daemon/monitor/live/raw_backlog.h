// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/lcm/lcm_log.h"
#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// Raw samples that an earlier process stored in the history after its last state, with the
/// temperatures between them, in the order in which they were received.
class RawBacklog {
 public:
  /// The longest strong motion that is read, and the time before a strong motion that is kept.
  static constexpr double kMost_s = 960, kBefore_s = 60;
  static constexpr std::size_t kMaxSamples =
      8'000'000;  ///< 200 MB; with more sensors it covers fewer seconds

  struct Message {
    std::size_t before = 0;  ///< index of the sample that follows it
    drivers::LogEvent event;
  };

  /// Reads the samples after `known_us`, by axis (Estimation::newest_us()). `resumed`: the
  /// estimation continues from a state. Otherwise it keeps samples only if they end in a strong
  /// motion for [event_report], from kBefore_s before it. Without [history] the result is empty.
  /// Appends what cannot be read to `notes`.
  static RawBacklog read(const Config& config, const std::vector<std::int64_t>& known_us,
                         bool resumed, std::vector<std::string>& notes);

  bool empty() const { return next_ == samples_.size(); }
  /// Returns true if the stored samples were read to their end.
  bool read_whole() const { return whole_; }
  double seconds() const;  ///< from the first to the last sample
  /// Returns the sensor time of the first sample; 0 if empty.
  std::int64_t first_us() const;

  /// Calls `sample` and `message` with the remaining data, in order, until `enough()` returns true.
  template <typename Sample, typename Temperature, typename Enough>
  void give(Sample sample, Temperature message, Enough enough) {
    for (; next_ < samples_.size() && !enough(); ++next_) {
      for (; !messages_.empty() && messages_.front().before <= next_; messages_.pop_front())
        message(messages_.front().event);
      sample(samples_[next_]);
    }
    if (empty()) *this = RawBacklog(whole_);
  }

  RawBacklog() = default;

 private:
  explicit RawBacklog(bool whole) : whole_(whole) {}
  void keep_strong_motion(const Config& config);
  void drop_before(std::int64_t time_us);

  std::vector<estimator::AccelSample> samples_;
  std::deque<Message> messages_;
  std::size_t next_ = 0;
  bool whole_ = false;
};

}  // namespace framewatch::daemon
