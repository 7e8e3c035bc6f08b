#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimates/estimate_series.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// The allowed difference of a found number from the expected one; one of the three is given.
struct Tolerance {
  std::optional<double> absolute;    ///< in the parameter's unit
  std::optional<double> ratio;       ///< of the expected number
  std::optional<double> std_errors;  ///< published standard errors
  bool given() const { return absolute || ratio || std_errors; }
};

/// Seconds after the first sample; of windows their end.
struct ExpectedSpan {
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
};

/// [[parameter]]: expected values of some parameters in all windows of a span.
struct ParameterExpectation {
  std::vector<int> parameters;  ///< of the parameter table
  std::optional<double> median, q1, q3;
  std::optional<double> value;  ///< of every observable window
  Tolerance tolerance;
  std::optional<double> observable_ratio, observable_min_ratio, observable_max_ratio;
  double observable_tolerance = 0;
  ExpectedSpan span;
};

/// [counts]: at the end.
struct CountExpectation {
  std::string name;  ///< of ReplayCounts
  std::int64_t least, most;
};

/// [[event]]: event_t messages that are raised.
struct EventExpectation {
  std::string kind, place;  ///< empty: any
  std::int64_t count = 1;
  ExpectedSpan span;
};

/// The expected results of a replay (docs/replay-in-ci.md).
struct Expectations {
  std::string path, reason;
  std::vector<CountExpectation> counts;
  std::vector<ParameterExpectation> parameters;
  std::vector<EventExpectation> events;
};

/// Reads an expectation file for the parameters of `table`. Empty, with every problem at once, when
/// it is not valid.
std::optional<Expectations> load_expectations(const std::string& path,
                                              const estimator::ParameterTable& table,
                                              std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
