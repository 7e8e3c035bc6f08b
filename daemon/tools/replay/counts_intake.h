// SPDX-License-Identifier: MIT
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

/// Returns true if `channel` is an LCM channel of a history's raw logs: sample counts or their
/// channel table.
bool is_of_raw_log(const std::string& channel);

/// Decodes the samples of a history's raw logs: accel_counts_t messages, whose channels are matched
/// with sensor axes by name. Missing readings become NaN.
class CountsIntake {
 public:
  using Sink = std::function<void(const estimator::AccelSample&)>;

  /// axes: names of the sensor axes; the index of a name is the axis of its samples.
  explicit CountsIntake(std::vector<std::string> axes) : axes_(std::move(axes)) {}

  /// Decodes one message of a channel for which is_of_raw_log() is true, and passes its samples to
  /// `sink` in the order in which they were received. Returns `malformed`, without samples, when
  /// the message cannot be decoded or arrives before the channel table.
  drivers::IntakeResult message(const std::string& channel, std::span<const std::uint8_t> data,
                                const Sink& sink);
  /// Forgets the channel table: the next log may have another one.
  void log_begins() { place_.clear(); }

  double rate_hz() const { return rate_hz_; }  ///< of the newest table; 0: not given
  /// Channels of the newest table that no axis is named after.
  const std::vector<std::string>& unknown() const { return unknown_; }
  /// Axes that the newest table does not name.
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  drivers::IntakeResult table(std::span<const std::uint8_t> data);

  std::vector<std::string> axes_, unknown_, missing_;
  std::vector<int> place_;  ///< axis of each channel; -1: no axis has its name
  double rate_hz_ = 0;
};

}  // namespace framewatch::daemon
