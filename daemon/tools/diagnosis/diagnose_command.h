// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/tools/diagnosis/diagnose_run.h"

namespace framewatch::daemon {

/// Runs `framewatch diagnose`. Returns the exit code: 0 adequate or explained, 1 a gap remains, 2
/// bad usage or input.
int diagnose_command(const DiagnoseArguments& arguments);

}  // namespace framewatch::daemon
