#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/sqlite_file.h"

namespace framewatch::fleet {

/// How many events and closed periods the history has of each day of the 30 before `newest_us`, as
/// JSON: {"format": "framewatch.inventory/1", "days": [{"day": "2026-11-24", "from_us": ...,
/// "events": 3, "periods": {"600": 144}}]}. Days without any are left out; periods shorter than
/// `least_s` too. Empty when the history cannot be read.
std::string inventory(daemon::SqliteFile& history, std::int64_t newest_us, std::int64_t least_s);

}  // namespace framewatch::fleet
