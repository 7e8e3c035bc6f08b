#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/can_status_t.hpp>

#include "daemon/config.h"
#include "daemon/once_a_second.h"
#include "drivers/can/can_intake.h"
#include "drivers/can/can_source.h"

namespace framewatch::daemon {

/// How busy the buses are, by the interfaces' own counters: frames that no filter lets through
/// count too.
class CanMonitor {
 public:
  /// `config` must outlive this. `statistics`: folder with a folder per interface.
  explicit CanMonitor(const Config& config, std::string statistics = "/sys/class/net");

  /// Once a second; empty in between, and without CAN.
  std::optional<can_status_t> look(const drivers::CanIntake& can, const drivers::CanSource& source,
                                   std::int64_t now_us);

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
  std::vector<bool> extended_, fd_;  ///< whether the nodes of a bus have such frames
  OnceASecond second_;
  std::int64_t last_us_ = 0;
};

}  // namespace framewatch::daemon
