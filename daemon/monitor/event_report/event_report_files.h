#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/monitor/event_report/event_report.h"

namespace framewatch::daemon {

/// What a stored report says in a line.
struct EventReportSummary {
  std::string name;  ///< of its files, without their ending
  EventColor color = EventColor::green;
  std::string reason;                             ///< the gravest
  std::int64_t start_us = 0, end_us = 0;          ///< of the strong motion, sensor time
  std::string placard = {}, placard_reason = {};  ///< in words; empty: none was given
};

/// Whether a text is as event_report_name() makes them: nothing that leads elsewhere.
bool is_event_report_name(const std::string& name);
/// Names of the reports in a folder, oldest first; none where there is no folder.
std::vector<std::string> event_report_names(const std::string& folder);
/// Of one of them; empty when its JSON file is none, or reached by a link.
std::optional<EventReportSummary> event_report_summary(const std::string& folder,
                                                       const std::string& name);

/// The newest report of a folder, read again when there is a newer one.
class NewestEventReport {
 public:
  /// folder: empty: there is none.
  explicit NewestEventReport(std::string folder);

  const std::optional<EventReportSummary>& poll();
  const std::optional<EventReportSummary>& newest() const { return newest_; }  ///< at the last look

 private:
  std::string folder_, name_;
  std::optional<EventReportSummary> newest_;
};

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
