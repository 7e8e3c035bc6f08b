#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

/// The logs of a demo that is to have a report, in a temporary folder of their own. Without a
/// report nothing is stored.
class DemoLogs {
 public:
  /// report: the page to write; empty: none. stories: of the building that is shown.
  DemoLogs(const std::string& report, int stories);
  ~DemoLogs();
  DemoLogs(const DemoLogs&) = delete;
  DemoLogs& operator=(const DemoLogs&) = delete;

  void raw(std::int64_t time_us, const std::string& channel, const void* data, std::size_t size);
  void estimate(std::int64_t time_us, const std::string& channel,
                const std::vector<std::uint8_t>& bytes);
  /// Closes the logs and writes the report about them.
  void write_report();

 private:
  std::string report_, folder_;
  int stories_;
  bool open_ = false;
  drivers::LcmLogWriter raw_, estimates_;
};

}  // namespace framewatch::daemon
