#pragma once

#include <string>
#include <vector>

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

}  // namespace framewatch::daemon
