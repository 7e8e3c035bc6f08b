#pragma once

#include <cstdint>
#include <framewatch/event_t.hpp>
#include <optional>
#include <vector>

#include "drivers/can/can_map.h"
#include "drivers/can/can_status.h"

namespace framewatch::daemon {

/// Turns CAN notices into events: bus_off and interface_gone of buses, emergency, boot_up,
/// sequence_leap, duplicates and losses of nodes. The id depends on kind and place alone and is
/// larger than the ids of alarms.
class CanEvents {
 public:
  /// `map` must outlive this.
  explicit CanEvents(const drivers::CanMap& map);

  /// Empty when nothing changed: the state has already begun, or ends without a beginning.
  std::optional<event_t> of(const drivers::CanNotice& notice);

  template <typename Archive>
  void archive(Archive& a) {
    a(begun_);
  }

 private:
  struct Begun {
    std::int64_t since_us = 0;
    bool on = false;
    int code = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a(since_us, on, code);
    }
  };

  const drivers::CanMap& map_;
  std::vector<Begun> begun_;  ///< by kind, then by bus or node
};

}  // namespace framewatch::daemon
