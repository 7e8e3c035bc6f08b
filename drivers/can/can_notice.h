#pragma once

#include <cstdint>
#include <functional>

namespace framewatch::drivers {

/// Something a person may want to know of a bus or a node, when it begins and when it is over.
struct CanNotice {
  enum class Kind {
    bus_off,         ///< of a bus: the controller has taken itself off it
    interface_gone,  ///< of a bus: down or removed
    emergency,       ///< of a node: CANopen EMCY, `code` says which
    boot_up,         ///< of a node: CANopen; over as it begins
    // Of a node's numbers, `code` messages within 10 s:
    sequence_leap,  ///< it began anew, or another node sends under its ids
    duplicates,     ///< likewise
    losses,
  };
  Kind kind = Kind::bus_off;
  int index = 0;  ///< of the bus or the node in the map
  bool over = false;
  int code = 0;
  std::int64_t time_us = 0;  ///< receive stamp
};

using CanNoticeSink = std::function<void(const CanNotice&)>;

}  // namespace framewatch::drivers
