// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimates/estimate_series.h"
#include "daemon/tools/replay/replay_summary.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// Allowed difference between a value found and the value expected. One of the three is given.
struct Tolerance {
  std::optional<double> absolute;    ///< in the parameter's unit
  std::optional<double> ratio;       ///< of the expected value
  std::optional<double> std_errors;  ///< published standard errors
};

/// Interval in seconds after the first sample. A window belongs to it by its end.
struct ExpectedSpan {
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
};

/// [[parameter]]: expected values of some parameters in all windows of a span.
struct ParameterExpectation {
  std::vector<int> parameters;  ///< indices in the parameter table
  std::optional<double> median, q1, q3;
  std::optional<double> value;  ///< of every observable window
  Tolerance tolerance;
  std::optional<double> observable_ratio, observable_min_ratio, observable_max_ratio;
  double observable_tolerance = 0;
  ExpectedSpan span;
};

/// [counts]: bounds of a count at the end of the replay.
struct CountExpectation {
  std::string name;  ///< of ReplayCounts
  std::int64_t least, most;
};

/// [[event]]: number of event_t messages raised.
struct EventExpectation {
  std::string kind, place;  ///< empty: any
  std::int64_t count = 1;
  ExpectedSpan span;
};

/// Expected results of a replay (docs/replay-in-ci.md).
struct Expectations {
  std::string path, reason;
  std::vector<CountExpectation> counts;
  std::vector<ParameterExpectation> parameters;
  std::vector<EventExpectation> events;
};

/// Reads an expectation file for the parameters of `table`. Returns nullopt and appends every
/// problem to `problems` when the file is not valid.
std::optional<Expectations> load_expectations(const std::string& path,
                                              const estimator::ParameterTable& table,
                                              std::vector<ConfigProblem>& problems);

/// An event_t that was raised during the replay.
struct RaisedEvent {
  std::string kind, place;
  std::int64_t since_us = 0;  ///< sensor time
};

/// Results of a replay that expectations are compared with.
struct ReplayOutcome {
  const EstimateSeries& series;
  const ReplayCounts& counts;
  const std::vector<RaisedEvent>& events;
  std::int64_t first_us;  ///< sensor time of the first sample
};

/// Comparison of one expectation with the result.
struct Check {
  std::string subject;   ///< parameter, count or event
  std::string quantity;  ///< "median", "observable share", ...
  std::string unit;
  double expected = 0, found = 0;
  double allowed = 0;  ///< allowed distance
  std::string rule;    ///< the tolerance as the file gives it: "1 %"
  bool holds = false;
  /// Seconds after the first sample of the first and of the farthest window outside the tolerance.
  /// Given for window quantities that do not hold.
  std::optional<double> first_s, farthest_s;
  double farthest = 0;  ///< value at farthest_s

  std::string name() const { return subject + " " + quantity; }
  double distance() const;
  /// Returns one line: subject, expected value, found value, difference and time.
  std::string text() const;
};

/// Compares the results with every expectation; one check per expectation and parameter.
std::vector<Check> check_expectations(const Expectations& expectations, const ReplayOutcome& found);

/// Returns the text of an expectation file that the found results meet. Its reason is empty, for
/// the user to fill in. command: the command line, for a comment.
std::string written_expectations(const ReplayOutcome& found, const std::string& command);

/// Returns JUnit XML with one test case per check.
std::string junit_xml(const std::vector<Check>& checks, const std::string& suite);
/// Returns the checks that do not hold as a JSON array.
std::string differences_json(const std::vector<Check>& checks);

}  // namespace framewatch::daemon
