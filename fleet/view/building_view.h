// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fleet/message/message.h"
#include "fleet/store/database.h"

namespace framewatch::fleet {

/// Returns one building as JSON: its description and urgency, as in overview_json(), and:
///   "raised"      raised events
///   "parameters"  newest values and baselines; "observed_us" is missing if none within a day
///   "channels"    state of the sensors and the process
///   "events"      the newest 200
///   "stretches"   requested raw samples; "problem": why none came
/// Returns {"problem": ..} for an unknown name.
std::string building_json(Database& database, const std::string& name);

/// Raw samples that a building sent on request.
struct FetchedSamples {
  std::string file;  ///< name with the format as its ending
  Bytes miniseed;
};

/// Returns the samples of a request when all pieces have come. Otherwise returns nullopt and sets
/// `why`: pieces are missing, or the building's reason for sending nothing.
std::optional<FetchedSamples> read_fetched(Database& database, const std::string& building,
                                           const std::string& request, std::string& why);

struct SeriesRequest {
  static constexpr std::size_t kMaxPoints = 1500;

  std::string building, parameter;
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time
  int period_s = 0;                     ///< 0: the finest that gives at most kMaxPoints
};

/// Returns the periods of a parameter as JSON: {"period_s", "of": periods in one point, "unit",
/// "t_us": [], "median": [], "q1": [], "q3": [], "std_error": [], "windows": []}; null where it was
/// not observable. Joins more periods than kMaxPoints: median of the medians, widest quartiles.
/// Returns {"problem": ".."} if the database fails.
std::string series_json(Database& database, const SeriesRequest& request);

}  // namespace framewatch::fleet
