#pragma once

#include "daemon/monitor/history/history_request.h"

namespace framewatch::daemon {

/// framewatch history: what a history holds, and parts of it as files. Exit code.
int history(const HistoryArguments& arguments);

}  // namespace framewatch::daemon
