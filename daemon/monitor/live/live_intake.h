// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/can/can_source.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {

/// The loop that waits for live input, LCM messages and CAN frames, and passes it to two functions.
class LiveIntake {
 public:
  /// `lcm` and `can` must outlive this. At most `queue_capacity` messages of each of the LCM
  /// `channels` wait. With `every_frame` it receives all CAN frames, not only those of the
  /// configured nodes.
  LiveIntake(drivers::LcmProvider& lcm, const std::vector<std::string>& channels,
             int queue_capacity, drivers::LcmSource::Handler on_message, const drivers::CanMap& can,
             bool every_frame, drivers::CanSource::Handler on_frame);

  /// Opens the CAN buses. Returns one line for each problem.
  std::vector<std::string> open_buses() { return can_.open(); }
  /// Waits for input at most `timeout_ms` and passes on what has come. Returns false when LCM
  /// failed.
  [[nodiscard]] bool poll(int timeout_ms);

  const drivers::LcmSource& lcm() const { return lcm_; }
  drivers::CanSource& can() { return can_; }

 private:
  bool has_buses_;
  drivers::LcmSource lcm_;
  drivers::CanSource can_;
};

/// Returns the LCM channels of samples and of their channel tables.
std::vector<std::string> sample_channels(const Config& config);
/// Returns the LCM channels that an estimation needs: the sample_channels() and those of weather.
std::vector<std::string> heard_channels(const Config& config);

/// Returns why no sample can be received: no channel has a source, and nodes do not name channels
/// (`by_name`). Empty if samples can come.
std::string nothing_to_hear(const Config& config, bool by_name);
/// Returns the names of the channels without a source, for a warning. Empty if all have one or if
/// nodes name channels (`by_name`).
std::string channels_without_source(const Config& config, bool by_name);

std::string acknowledge_channel(const Config& config);

}  // namespace framewatch::daemon
