#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "drivers/can/can_intake.h"
#include "drivers/can/can_source.h"

namespace framewatch::daemon {

/// Log lines about problems of the CAN buses: once a second at most, and only about changes.
class CanWarnings {
 public:
  explicit CanWarnings(const Config& config);

  /// One line for each bus with news; to be called several times a second. now_us: host clock.
  std::vector<std::string> look(const drivers::CanIntake& can, const drivers::CanSource& source,
                                std::int64_t now_us);

 private:
  struct Bus {
    drivers::CanBusCounters counters;
    bool open = true;
  };
  struct Node {
    drivers::CanNodeCounters counters;
    bool silent = false;
  };
  std::string bus_news(std::size_t bus, const drivers::CanBusCounters& now, bool open);
  std::string node_news(std::size_t node, const drivers::CanNodeCounters& now);

  const Config& config_;
  std::vector<Bus> buses_;
  std::vector<Node> nodes_;
  OnceASecond second_;
  bool begun_ = false;
  std::int64_t dropped_ = 0, steps_ = 0;
};

}  // namespace framewatch::daemon
