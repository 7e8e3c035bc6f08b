#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_field.h"

namespace framewatch::drivers {

/// What says when a node's samples were taken.
enum class CanTiming {
  sync,     ///< the SYNC before the frame (CANopen)
  clock,    ///< a time in the node's frames
  counter,  ///< a sample counter in the node's frames, times the period
  period,   ///< nothing: the frames' arrival and the period
};

/// One signal of a message and which sensor axis it is.
struct CanReading {
  CanField field;
  int axis = 0;
  int sample = 0;  ///< of those in one frame, from 0
  std::string name;
  /// Physical values outside are no measurement: no instant of the grid is made of them.
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// One message of a node, at one value of its multiplexor if it has one.
struct CanMessageMap {
  std::string name;
  std::uint32_t id = 0;
  std::uint32_t mask = 0;  ///< bits of the id that must agree
  bool extended = false;
  int length = 0;   ///< bytes; another length is a wrong one
  bool fd = false;  ///< must come as a CAN FD frame
  std::optional<CanField> multiplexor;
  std::int64_t multiplexor_value = 0;
  std::vector<CanReading> readings;
  std::optional<CanField> counter;  ///< the node's, in this message
  std::optional<CanField> clock;
};

/// A device that sends samples: an accelerometer with one to three axes, mostly.
struct CanNodeMap {
  std::string name;
  int bus = 0;
  std::vector<CanMessageMap> messages;  ///< the first one opens a sample, the others add to it
  CanTiming timing = CanTiming::period;
  double period_us = 10000;  ///< between samples
  double clock_unit_us = 1;  ///< microseconds per unit of the clock's physical value
  double delay_us = 0;       ///< sampling instant after the SYNC
  double latency_us = 0;     ///< from the sampling instant to the frame's arrival on an idle bus
  int samples_per_frame = 1;
  int canopen_id = 0;  ///< 1..127: its EMCY, boot-up and heartbeat are seen; 0: none
};

struct CanBusMap {
  std::string interface;
  bool fd = false;
  int bit_rate = 500000, data_bit_rate = 2000000;
  std::uint32_t sync_id = 0x80;
  double sync_period_us = 10000;
  bool send_sync = false;
  bool nmt_start = false;
  std::int16_t sync_overflow = 0;  ///< the SYNC carries a counter from 1 to this; 0: none
  int receive_buffer_bytes = 2097152;
};

/// How samples are read from the buses: what the configuration and its DBC files say.
struct CanMap {
  std::vector<CanBusMap> buses;
  std::vector<CanNodeMap> nodes;
  double grid_period_us = 10000;  ///< of the estimator
  /// Nodes with clocks of their own are brought to instants that are multiples of the grid's
  /// period.
  bool resample = false;

  bool empty() const { return nodes.empty(); }
};

/// Whether a frame with this id is the message.
inline bool matches(const CanMessageMap& message, std::uint32_t id, bool extended) {
  return extended == message.extended && ((id ^ message.id) & message.mask) == 0;
}

}  // namespace framewatch::drivers
