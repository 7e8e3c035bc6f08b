#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/can/can_source.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {

/// The one loop that waits for live input: LCM messages and CAN frames, handed to two functions.
class LiveIntake {
 public:
  /// `lcm` and `can` must outlive this. channels: of LCM, at most `queue_capacity` messages of each
  /// wait. every_frame: receives all CAN frames, not only those of the configured nodes.
  LiveIntake(drivers::LcmProvider& lcm, const std::vector<std::string>& channels,
             int queue_capacity, drivers::LcmSource::Handler on_message, const drivers::CanMap& can,
             bool every_frame, drivers::CanSource::Handler on_frame);

  /// Opens the CAN buses. Returns one line for each problem.
  std::vector<std::string> open_buses() { return can_.open(); }
  /// Waits for input at most `timeout_ms` and hands over what is there. Returns false when LCM
  /// failed.
  [[nodiscard]] bool poll(int timeout_ms);

  const drivers::LcmSource& lcm() const { return lcm_; }
  drivers::CanSource& can() { return can_; }
  const drivers::CanSource& can() const { return can_; }

 private:
  bool has_buses_;
  drivers::LcmSource lcm_;
  drivers::CanSource can_;
};

/// The LCM channels of samples and of their channel tables.
std::vector<std::string> sample_channels(const Config& config);
/// The channels an estimation listens to: those and the one of the thermometer.
std::vector<std::string> heard_channels(const Config& config);

/// Why nothing can be received: no channel has a source, and nodes do not name them (`by_name`).
/// Empty: something can.
std::string nothing_to_hear(const Config& config, bool by_name);
/// The names of the channels without a source, for a warning; empty when there are none, and when
/// nodes name them.
std::string channels_without_source(const Config& config, bool by_name);

/// Where somebody on LCM may ask `framewatch run` to acknowledge an event.
std::string acknowledge_channel(const Config& config);

}  // namespace framewatch::daemon
