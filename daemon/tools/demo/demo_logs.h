#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/tools/demo/demo_scenario.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

/// The logs of a demo that is to have a report, in a temporary folder of their own. Without a
/// report nothing is stored.
class DemoLogs {
 public:
  /// report: the page to write; empty: none.
  explicit DemoLogs(const std::string& report);
  ~DemoLogs();
  DemoLogs(const DemoLogs&) = delete;
  DemoLogs& operator=(const DemoLogs&) = delete;

  void raw(std::int64_t time_us, const std::string& channel, const void* data, std::size_t size);
  void estimate(std::int64_t time_us, const std::string& channel,
                const std::vector<std::uint8_t>& bytes);
  /// Closes the logs and writes the report about them. building: that was shaken.
  void write_report(const DemoBuilding& building);

 private:
  std::string report_, folder_;
  bool open_ = false;
  drivers::LcmLogWriter raw_, estimates_;
};

}  // namespace framewatch::daemon
