#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/monitor/estimates/estimate_series.h"
#include "daemon/tools/replay/expectation.h"
#include "daemon/tools/replay/replay_summary.h"

namespace framewatch::daemon {

/// An event_t that was raised.
struct RaisedEvent {
  std::string kind, place;
  std::int64_t since_us = 0;
};

/// The results of a replay.
struct ReplayOutcome {
  const EstimateSeries& series;
  const ReplayCounts& counts;
  const std::vector<RaisedEvent>& events;
  std::int64_t first_us;  ///< sensor time of the first sample
};

/// One expectation, compared with the result.
struct Check {
  std::string subject;   ///< parameter, count or event
  std::string quantity;  ///< "median", "observable share", ...
  std::string unit;
  double expected = 0, found = 0;
  double allowed = 0;  ///< distance
  std::string rule;    ///< of the tolerance, as the file gives it: "1 %"
  bool holds = false;
  /// When it does not: seconds after the first sample of the first and of the farthest window that
  /// is outside, if it is about windows.
  std::optional<double> first_s, farthest_s;
  double farthest = 0;  ///< value there

  std::string name() const { return subject + " " + quantity; }
  double distance() const;
  /// One line: parameter, expected, found, how far, at which time.
  std::string text() const;
};

std::vector<Check> check_expectations(const Expectations& expectations, const ReplayOutcome& found);

/// A first expectation file that the found results meet; its reason is left to be filled in.
std::string written_expectations(const ReplayOutcome& found, const std::string& command);

/// JUnit's XML, one test case per check.
std::string junit_xml(const std::vector<Check>& checks, const std::string& suite);
/// The checks that do not hold as a JSON array.
std::string differences_json(const std::vector<Check>& checks);

}  // namespace framewatch::daemon
