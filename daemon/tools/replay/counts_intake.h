#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "drivers/lcm/accel_intake.h"
#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// Whether an LCM channel is one of those in the raw logs of a history.
bool is_of_raw_log(const std::string& channel);

/// Samples out of the raw logs of a history: accel_counts_t, whose channels are those axes that
/// have their names. What the sensor did not say comes as NaN.
class CountsIntake {
 public:
  using Sink = std::function<void(const estimator::AccelSample&)>;

  /// Names of the sensor axes, in their order.
  explicit CountsIntake(std::vector<std::string> axes) : axes_(std::move(axes)) {}

  /// One message of a channel that is_of_raw_log(), whose samples go to `sink` in the order in
  /// which they were received. `malformed`: it is not what the channel says, or comes before the
  /// table of the channels; then there are none.
  drivers::IntakeResult message(const std::string& channel, std::span<const std::uint8_t> data,
                                const Sink& sink);
  /// Another log follows, whose table may be another.
  void log_begins() { place_.clear(); }

  double rate_hz() const { return rate_hz_; }  ///< of the newest table; 0: none, or it does not say
  /// Of the newest table: channels that no axis is named as, and axes that no channel is.
  const std::vector<std::string>& unknown() const { return unknown_; }
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  drivers::IntakeResult table(std::span<const std::uint8_t> data);

  std::vector<std::string> axes_, unknown_, missing_;
  std::vector<int> place_;  ///< axis of each channel; -1: none
  double rate_hz_ = 0;
};

}  // namespace framewatch::daemon
