// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_verdict.h"

namespace framewatch::daemon {

/// Returns the content of report.html, a self-contained page.
std::string diagnosis_report(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
