// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/monitor/history/history_request.h"

namespace framewatch::daemon {

/// Writes the requested raw samples to the file HistoryArguments::raw and prints notes about it.
/// After a problem no file remains.
void export_raw_history(const HistoryArguments& arguments, const HistoryRequest& request,
                        std::vector<std::string>& problems);

}  // namespace framewatch::daemon
