// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"

namespace framewatch::drivers {

/// The source of the sampling times of a node.
enum class CanTiming {
  sync,     ///< the SYNC before the frame (CANopen)
  clock,    ///< a time in the node's frames
  counter,  ///< a sample counter in the node's frames times the period
  period,   ///< the arrival of the frames and the period
};

/// One signal of a message and its sensor axis.
struct CanReading {
  CanField field;
  int axis = 0;
  int sample = 0;  ///< index among the samples of one frame
  std::string name;
  /// Physical values outside are not measurements; resampling ignores them.
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// One message of a node; of a multiplexed message, the part that the same multiplexors switch.
struct CanMessageMap {
  std::string name;
  std::uint32_t id = 0;
  std::uint32_t mask = 0;  ///< bits of the id that must agree
  bool extended = false;
  int length = 0;                   ///< bytes; frames of another length are rejected
  bool fd = false;                  ///< must come as a CAN FD frame
  std::vector<CanSwitch> switches;  ///< frames in which one of them is off are ignored
  std::vector<CanReading> readings;
  std::optional<CanField> counter;  ///< sample counter of the node
  std::optional<CanField> clock;    ///< clock of the node
};

/// A device that sends samples, usually an accelerometer with one to three axes.
struct CanNodeMap {
  std::string name;
  int bus = 0;
  std::vector<CanMessageMap> messages;  ///< the first one opens a sample, the others extend it
  CanTiming timing = CanTiming::period;
  double period_us = 10000;  ///< between samples
  double clock_unit_us = 1;  ///< microseconds per unit of the clock's physical value
  double delay_us = 0;       ///< from the SYNC to the sampling instant
  double latency_us = 0;     ///< from the sampling instant to the frame's arrival on an idle bus
  int samples_per_frame = 1;
  int canopen_id = 0;  ///< 1..127 to follow its EMCY, boot-up and heartbeat; 0: not CANopen
};

/// A bus and its settings.
struct CanBusMap {
  std::string interface;
  bool fd = false;
  int bit_rate = 500000, data_bit_rate = 2000000;
  std::uint32_t sync_id = 0x80;
  double sync_period_us = 10000;
  bool send_sync = false;
  bool nmt_start = false;
  std::int16_t sync_overflow = 0;  ///< the SYNC counts from 1 to this; 0: no counter
  int receive_buffer_bytes = 2097152;
};

/// A signal that stands by itself, such as a temperature, not a sample of an axis.
struct CanValueMap {
  int bus = 0;
  CanMessageMap message;  ///< without readings
  CanField field;
  std::size_t covariate = 0;  ///< index in the configuration
};

/// Says how to read samples from the buses, from the configuration and its DBC files.
struct CanMap {
  std::vector<CanBusMap> buses;
  std::vector<CanNodeMap> nodes;
  std::vector<CanValueMap> values;
  double grid_period_us = 10000;  ///< between the instants of the estimator
  /// Resamples nodes with their own clocks to multiples of grid_period_us.
  bool resample = false;

  bool empty() const { return nodes.empty() && values.empty(); }
  /// Returns true if a node of the bus samples at the SYNC.
  bool has_sync(int bus) const {
    return std::any_of(nodes.begin(), nodes.end(), [&](const CanNodeMap& node) {
      return node.bus == bus && node.timing == CanTiming::sync;
    });
  }
};

/// Returns the SYNC of a bus. `number` counts them from 0.
inline CanFrame sync_frame(const CanBusMap& bus, std::int64_t number) {
  CanFrame sync;
  sync.id = bus.sync_id;
  if (bus.sync_overflow > 0) {
    sync.length = 1;
    sync.data[0] = static_cast<std::uint8_t>(1 + number % bus.sync_overflow);
  }
  return sync;
}

}  // namespace framewatch::drivers
