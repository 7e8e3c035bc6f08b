#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_output.h"

namespace framewatch::daemon {

/// report.html: a self-contained page.
std::string diagnosis_report(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
