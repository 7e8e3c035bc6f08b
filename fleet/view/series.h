#pragma once

#include <cstdint>
#include <string>

#include "fleet/store/database.h"

namespace framewatch::fleet {

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
