// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "drivers/can/can_frame.h"

namespace framewatch::drivers {

/// The state of a controller according to the kernel's error frames.
enum class CanBusState { active, warning, passive, off };

/// Returns "error-active", "error-warning", "error-passive" or "bus-off".
std::string to_string(CanBusState state);

/// Counts the frames of a bus.
struct CanBusCounters {
  std::int64_t frames = 0;
  std::int64_t foreign = 0;  ///< ids of no configured node
  std::int64_t remote = 0;
  std::int64_t error_frames = 0;
  std::int64_t bus_off = 0;     ///< times
  std::int64_t restarted = 0;   ///< times the controller came back from bus-off
  std::int64_t overflow = 0;    ///< overflows of the receive buffer of the controller
  std::int64_t bus_errors = 0;  ///< protocol, acknowledgement and transceiver
  std::int64_t syncs = 0;
  CanBusState state = CanBusState::active;

  template <typename Archive>
  void archive(Archive& a) {
    a(frames, foreign, remote, error_frames, bus_off, restarted, overflow, bus_errors, syncs);
    a(state);
  }
};

/// Adds an error frame to the counters and updates the state (linux/can/error.h).
void count_error_frame(const CanFrame& frame, CanBusCounters& counters);

/// Counts the messages and samples of a node.
struct CanNodeCounters {
  std::int64_t frames = 0;    ///< frames with mapped messages of the node
  std::int64_t received = 0;  ///< samples accepted
  std::int64_t lost = 0;      ///< missing numbers
  std::int64_t duplicates = 0;
  std::int64_t reordered = 0;  ///< came after a later one and kept their time
  std::int64_t late = 0;       ///< came after the SYNC window, or after the next SYNC
  std::int64_t unplaced = 0;   ///< no SYNC, counter or clock gives their time
  std::int64_t wrong_length = 0;
  std::int64_t wrong_kind = 0;  ///< classical instead of CAN FD, or the reverse
  std::int64_t not_finite = 0;  ///< values that are NaN or infinite
  std::int64_t restarts = 0;
  std::int64_t boot_ups = 0;     ///< CANopen
  std::int64_t emergencies = 0;  ///< CANopen EMCY with an error in it
  std::uint16_t last_emergency = 0;
  std::int64_t repaired = 0;  ///< single losses filled before resampling
  std::int64_t last_stamp_us = 0;
  double first_time_us = 0, last_time_us = 0;  ///< of accepted samples
  /// Returns accepted frames per second; 0 before the second one.
  double rate_hz() const {
    return received > 1 && last_time_us > first_time_us
               ? 1e6 * static_cast<double>(received - 1) / (last_time_us - first_time_us)
               : 0;
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(frames, received, lost, duplicates, reordered, late, unplaced, wrong_length, wrong_kind);
    a(not_finite, restarts, boot_ups, emergencies, last_emergency, repaired, last_stamp_us);
    a(first_time_us, last_time_us);
  }
};

/// The smallest and largest value decoded, with scale and offset of the DBC.
struct CanRange {
  double least = 0, most = 0;
  std::int64_t count = 0;

  template <typename Archive>
  void archive(Archive& a) {
    a(least, most, count);
  }
};

/// Reports an event of a bus or a node to a person, when it begins and when it is over.
struct CanNotice {
  enum class Kind {
    bus_off,         ///< bus: the controller has left the bus
    interface_gone,  ///< bus: the interface is down or was removed
    emergency,       ///< node: CANopen EMCY; `code` is its error code
    boot_up,         ///< node: CANopen boot-up; over as it begins
    sequence_leap,   ///< node: it restarted, or another node sends under its ids
    duplicates,      ///< node: `code` messages came twice within 10 s
    losses,          ///< node: `code` messages were lost within 10 s
  };
  Kind kind = Kind::bus_off;
  int index = 0;  ///< index of the bus or the node in the map
  bool over = false;
  int code = 0;
  std::int64_t time_us = 0;  ///< receive stamp
};

using CanNoticeSink = std::function<void(const CanNotice&)>;

}  // namespace framewatch::drivers
