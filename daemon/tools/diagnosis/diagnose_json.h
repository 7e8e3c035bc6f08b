// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_verdict.h"

namespace framewatch::daemon {

/// Returns the content of diagnosis.json, schema framewatch.diagnosis/1 (docs/formats.md).
std::string diagnosis_json(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
