#pragma once

#include <cstdint>

#include "daemon/config/keys/history_options.h"

namespace framewatch::daemon {

/// Removes closed raw logs that are older than keep_days before `now_us`, and the oldest while
/// there is more than keep_gb of them. Samples of an event of kind gap or
/// stiffness_change are first copied to the folder of events; the log stays when that fails.
void remove_old_raw_logs(const HistorySettings& settings, std::int64_t now_us);

}  // namespace framewatch::daemon
