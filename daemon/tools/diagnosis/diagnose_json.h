#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_output.h"

namespace framewatch::daemon {

/// diagnosis.json, schema framewatch.diagnosis/1 (docs/formats.md).
std::string diagnosis_json(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
