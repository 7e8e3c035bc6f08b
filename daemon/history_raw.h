#pragma once

#include <string>
#include <vector>

#include "daemon/history_command.h"
#include "daemon/history_request.h"

namespace framewatch::daemon {

/// Writes the raw samples that are asked for as HistoryArguments::raw and prints what a person
/// should know about the file. With a problem there is no file.
void export_raw_history(const HistoryArguments& arguments, const HistoryRequest& request,
                        std::vector<std::string>& problems);

}  // namespace framewatch::daemon
