#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/can_status_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "drivers/can/can_intake.h"
#include "drivers/can/can_source.h"

namespace framewatch::daemon {

/// Measures the load of the buses by the counters of their interfaces, which include frames that
/// the program does not receive.
class CanMonitor {
 public:
  /// `config` must outlive this. `statistics`: a folder with one folder per interface.
  explicit CanMonitor(const Config& config, std::string statistics = "/sys/class/net");

  /// The status once a second; empty in between and without CAN.
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
