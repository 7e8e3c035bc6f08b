#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fleet/message/message.h"
#include "fleet/store/database.h"

namespace framewatch::fleet {

/// One building: what it is and needs ("overview" has the same words), "raised" events,
/// "parameters" with their newest values against the baseline ("observed_us": of the period that
/// they are of, absent: not observable within a day), "channels", the process, "events" (the newest
/// 200), "stretches" (raw samples that were asked for; "problem": why nothing came). {"problem":
/// ..} when there is none of this name.
std::string building_json(Database& database, const std::string& name);

/// Raw samples that a building sent on request.
struct FetchedSamples {
  std::string file;  ///< name that says the format
  Bytes miniseed;
};

/// Of a request to a building, when all pieces have come; else empty, with the reason: none has,
/// some have not, or why the building has nothing to send.
std::optional<FetchedSamples> read_fetched(Database& database, const std::string& building,
                                           const std::string& request, std::string& why);

struct SeriesRequest {
  static constexpr std::size_t kMaxPoints = 1500;

  std::string building, parameter;
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time
  int period_s = 0;                     ///< 0: the finest that is there and not too fine
};

/// A parameter's periods: {"period_s", "of": periods in one point, "unit", "t_us": [], "median":
/// [], "q1": [], "q3": [], "std_error": [], "windows": []}; null where it was not observable. More
/// periods than kMaxPoints are joined: the median of the medians, the widest quartiles. Or
/// {"problem": ".."}.
std::string series_json(Database& database, const SeriesRequest& request);

}  // namespace framewatch::fleet
