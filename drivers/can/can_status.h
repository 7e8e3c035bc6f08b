#pragma once

#include <cstdint>
#include <string>

#include "drivers/can/can_frame.h"

namespace framewatch::drivers {

/// What the kernel's error frames say of a controller.
enum class CanBusState { active, warning, passive, off };

std::string to_string(CanBusState state);

struct CanBusCounters {
  std::int64_t frames = 0;
  std::int64_t foreign = 0;  ///< ids that no node of ours has
  std::int64_t remote = 0;
  std::int64_t error_frames = 0;
  std::int64_t bus_off = 0;     ///< times
  std::int64_t restarted = 0;   ///< times the controller came back from bus-off
  std::int64_t overflow = 0;    ///< receive buffer of the controller
  std::int64_t bus_errors = 0;  ///< protocol, acknowledgement and transceiver
  std::int64_t syncs = 0;
  CanBusState state = CanBusState::active;

  template <typename Archive>
  void archive(Archive& a) {
    a(frames, foreign, remote, error_frames, bus_off, restarted, overflow, bus_errors, syncs);
    a(state);
  }
};

/// Brings an error frame into the counters (linux/can/error.h).
void count_error_frame(const CanFrame& frame, CanBusCounters& counters);

struct CanNodeCounters {
  std::int64_t frames = 0;    ///< of the node's mapped messages, whatever became of them
  std::int64_t received = 0;  ///< taken
  std::int64_t lost = 0;      ///< numbers never seen
  std::int64_t duplicates = 0;
  std::int64_t reordered = 0;  ///< came after a later one; still placed at their time
  std::int64_t late = 0;       ///< after the SYNC window, or the next SYNC
  std::int64_t unplaced = 0;   ///< no SYNC, counter or clock tells when they were taken
  std::int64_t wrong_length = 0;
  std::int64_t wrong_kind = 0;  ///< classical for CAN FD, or the reverse
  std::int64_t not_finite = 0;  ///< values that are no number
  std::int64_t restarts = 0;
  std::int64_t boot_ups = 0;     ///< CANopen
  std::int64_t emergencies = 0;  ///< CANopen EMCY with an error in it
  std::uint16_t last_emergency = 0;
  std::int64_t repaired = 0;  ///< single losses filled before resampling
  std::int64_t last_stamp_us = 0;
  double first_time_us = 0, last_time_us = 0;  ///< of samples taken
  /// Frames a second, as decoded; 0 before the second one.
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

/// Smallest and largest value decoded, scale and offset of the DBC applied.
struct CanRange {
  double least = 0, most = 0;
  std::int64_t count = 0;

  template <typename Archive>
  void archive(Archive& a) {
    a(least, most, count);
  }
};

}  // namespace framewatch::drivers
