// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "daemon/monitor/event_report/event_report.h"

namespace framewatch::daemon {

/// The line about a stored report in a list.
struct EventReportSummary {
  std::string name;  ///< of its files, without their ending
  EventColor color = EventColor::green;
  std::string reason;                             ///< the gravest one
  std::int64_t start_us = 0, end_us = 0;          ///< of the strong motion, sensor time
  std::string placard = {}, placard_reason = {};  ///< in words; empty: no placard
};

/// Returns true if `name` has the form that event_report_name() makes, so it cannot lead to another
/// folder.
bool is_event_report_name(const std::string& name);
/// Returns the names of the reports in a folder, oldest first. A missing folder gives an empty
/// list.
std::vector<std::string> event_report_names(const std::string& folder);
/// Reads one of these reports. Returns nullopt if its JSON file is not a report or is a link.
std::optional<EventReportSummary> event_report_summary(const std::string& folder,
                                                       const std::string& name);

/// The newest report of a folder. Reads a report only once.
class NewestEventReport {
 public:
  /// An empty `folder`: the building has no reports.
  explicit NewestEventReport(std::string folder);

  /// Reads the newest report if it is newer than the last one read. Returns the newest report, or
  /// nullopt for an empty folder.
  const std::optional<EventReportSummary>& poll();
  /// Returns the newest report as of the last poll().
  const std::optional<EventReportSummary>& newest() const { return newest_; }

 private:
  std::string folder_, name_;
  std::optional<EventReportSummary> newest_;
};

/// Writes the page and the JSON file of a report into `directory`, which it creates if necessary,
/// and removes the oldest reports beyond EventReportSettings::most_reports. Returns an empty
/// string, or the reason of a failure.
std::string write_event_report(const EventReport& report, const Config& config,
                               const std::string& directory);

/// Writes reports from threads, so that a slow disk does not delay estimates. At most kMax reports
/// wait; the log names each report that is dropped.
class EventReportFiles {
 public:
  static constexpr std::size_t kMax = 4;

  /// Starts to write a report, with a copy of `config`.
  void write(const EventReport& report, const Config& config);

 private:
  std::vector<std::future<void>> writing_;  ///< of std::async: their destructors wait
};

}  // namespace framewatch::daemon
