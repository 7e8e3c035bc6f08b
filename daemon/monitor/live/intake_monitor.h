// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/can_status_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/live/live_estimation.h"
#include "drivers/can/can_intake.h"
#include "drivers/can/can_source.h"

namespace framewatch::daemon {

/// Measures the load of the buses by the counters of their interfaces, which include frames that
/// the program does not receive.
class CanMonitor {
 public:
  /// `config` must outlive this. `statistics` is a folder with one folder per interface.
  explicit CanMonitor(const Config& config, std::string statistics = "/sys/class/net");

  /// Returns the status once a second; nullopt between, and without CAN.
  std::optional<can_status_t> collect(const drivers::CanIntake& can,
                                      const drivers::CanSource& source, std::int64_t now_us);

 private:
  struct Counted {
    std::int64_t frames = 0, bytes = 0;
  };
  std::optional<Counted> counted(const std::string& interface) const;
  void add_bus(std::size_t bus, const drivers::CanIntake& can, const drivers::CanSource& source,
               double seconds, can_status_t& status);

  const Config& config_;
  std::string statistics_;
  std::vector<std::optional<Counted>> before_;
  std::vector<double> expected_load_;
  std::vector<bool> extended_, fd_;  ///< by bus: its nodes have such frames
  OnceASecond second_;
  std::int64_t last_us_ = 0;
};

/// Makes log lines about problems of the CAN buses: at most once a second, and only about changes.
class CanWarnings {
 public:
  explicit CanWarnings(const Config& config);

  /// Returns one line for each bus with news. Call it several times a second; `now_us`: host clock.
  std::vector<std::string> collect(const drivers::CanIntake& can, const drivers::CanSource& source,
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

/// Logs, at most once a second, which messages and samples were lost or rejected since the last
/// line.
class IntakeWarnings {
 public:
  /// Call it several times a second; `now_us`: host clock.
  void update(const LiveEstimation& live, std::int64_t now_us);

 private:
  OnceASecond second_;
  std::int64_t seen_[13] = {};
  std::vector<std::int64_t> rejected_;  ///< by axis
  bool said_unbound_ = false;
};

}  // namespace framewatch::daemon
