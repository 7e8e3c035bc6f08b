// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/monitor/history/history_request.h"

namespace framewatch::daemon {

/// Runs `framewatch history`: shows what a history holds, or writes parts of it as files. Returns
/// the exit code.
int history(const HistoryArguments& arguments);

}  // namespace framewatch::daemon
