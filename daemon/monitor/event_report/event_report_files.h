#pragma once

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "daemon/monitor/event_report/event_report.h"

namespace framewatch::daemon {

/// Writes the page and the JSON file of a report into a folder, which is made when it is not there,
/// and removes the oldest reports beyond EventReportSettings::most_reports. Empty, or why not.
std::string write_event_report(const EventReport& report, const Config& config,
                               const std::string& directory);

/// Writes reports in threads of their own, so that a slow disk delays no estimate. At most kMax
/// wait for it; what does not fit is said in the log.
class EventReportFiles {
 public:
  static constexpr std::size_t kMax = 4;

  EventReportFiles() = default;
  ~EventReportFiles();  ///< waits until they are written
  EventReportFiles(const EventReportFiles&) = delete;
  EventReportFiles& operator=(const EventReportFiles&) = delete;

  /// config is copied.
  void write(const EventReport& report, const Config& config);

 private:
  std::vector<std::future<void>> writing_;
};

}  // namespace framewatch::daemon
