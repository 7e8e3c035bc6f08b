#pragma once

#include <cstdint>
#include <string>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// What is compared: whole periods that end before the time, and that begin after it.
struct EarthquakeRequest {
  static constexpr std::int64_t kBefore_us = 600'000'000;  ///< of minutes, before the time
  static constexpr std::int64_t kSettle_us = 120'000'000;  ///< that the building may still move
  static constexpr std::int64_t kAfter_us = 720'000'000;   ///< of minutes, after the time
  static constexpr std::int64_t kLongBefore_us = 7'200'000'000;  ///< where there are no minutes
  static constexpr std::int64_t kLongAfter_us = 3'600'000'000;
  static constexpr int kMinPeriods = 3;  ///< before and after, that a finer length needs

  std::int64_t time_us = 0;  ///< sensor time
  std::string building;      ///< every value of this one alone; empty: every building, in short
};

/// Every building before and after: {"time_us", "times_error": that a loss must have, "compared":
/// in all, "buildings": [{"name", "title", "place", "result": loss | none | not_observable |
/// nothing, "period_s", "before", "after": periods, "compared", "significant": losses,
/// "not_observable": [names], "worst": {"parameter", "before", "after", "unit", "ratio",
/// "std_error"}}]}. Those with the largest significant loss stand first, those of which nothing can
/// be said last. With a building its "parameters" too. {"problem": ..} when the database does not
/// answer.
std::string earthquake_json(Database& database, const EarthquakeRequest& request);

/// Times at which buildings shook together, newest first, of the `days` before now: [{"time_us",
/// "until_us", "buildings": n}]. Three buildings at least whose strong motion or change of
/// stiffness began within 60 s.
std::string earthquakes_json(Database& database, int days);

}  // namespace framewatch::fleet
