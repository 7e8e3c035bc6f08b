// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// The time of an earthquake. Compares whole periods that end before it with those that begin
/// after.
struct EarthquakeRequest {
  static constexpr std::int64_t kBefore_us =
      600'000'000;  ///< range of 60 s periods before the time
  static constexpr std::int64_t kSettle_us =
      120'000'000;  ///< skipped, because the building may still move
  static constexpr std::int64_t kAfter_us = 720'000'000;  ///< range of 60 s periods after the time
  static constexpr std::int64_t kLongBefore_us = 7'200'000'000;  ///< range of longer periods
  static constexpr std::int64_t kLongAfter_us = 3'600'000'000;
  static constexpr int kMinPeriods = 3;  ///< least periods of 60 s before and after

  std::int64_t time_us = 0;  ///< sensor time
  std::string building;      ///< all values of this building; empty: all buildings in short
};

/// Returns every building before and after as JSON with "time_us", "times_error", "compared" and
/// "buildings". "times_error" is the number of standard errors of a significant loss. "compared" is
/// the number of comparisons. A building has "name", "title", "place", "period_s" and these fields:
///   "result"              loss, none, not_observable or nothing
///   "before", "after"     number of periods
///   "compared"            number of stiffnesses
///   "significant"         number of losses
///   "not_observable"      list of names
///   "worst"               {"parameter", "before", "after", "unit", "ratio", "std_error"}
/// Buildings with the largest significant loss come first, those without a result last. With a
/// building, includes its "parameters". Returns {"problem": ..} if the database fails.
std::string earthquake_json(Database& database, const EarthquakeRequest& request);

/// Returns the times of the last `days` at which buildings shook together, newest first, as JSON:
/// [{"time_us", "until_us", "buildings": n}]. At least three buildings must have strong motion or a
/// change of stiffness that began within 60 s.
std::string earthquakes_json(Database& database, int days);

}  // namespace framewatch::fleet
