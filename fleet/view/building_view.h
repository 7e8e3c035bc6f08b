#pragma once

#include <string>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// One building: what it is and needs ("overview" has the same words), "raised" events,
/// "parameters" with their newest values against the baseline ("observed_us": of the period that
/// they are of, absent: not observable within a day), "channels", the process, "events" (the newest
/// 200), "stretches" (raw samples that were asked for; "problem": why nothing came). {"problem":
/// ..} when there is none of this name.
std::string building_json(Database& database, const std::string& name);

}  // namespace framewatch::fleet
