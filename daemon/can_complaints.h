#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/once_a_second.h"
#include "drivers/can/can_intake.h"
#include "drivers/can/can_source.h"

namespace framewatch::daemon {

/// What a person should know of the CAN buses, told once a second at most and only when it changed.
class CanComplaints {
 public:
  explicit CanComplaints(const Config& config);

  /// One line for each bus with news.
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
