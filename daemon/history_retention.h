#pragma once

#include <cstdint>

#include "daemon/history_options.h"

namespace framewatch::daemon {

/// Removes closed raw logs that are older than keep_days before `now_us`, and the oldest while
/// there is more than keep_gb of them. What of a log belongs to a gap or to a change of stiffness
/// goes to the folder of events first; while that, or the list of events, cannot be read or
/// written, the log stays.
void remove_old_raw_logs(const HistorySettings& settings, std::int64_t now_us);

}  // namespace framewatch::daemon
