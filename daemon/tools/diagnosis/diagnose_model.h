#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_output.h"

namespace framewatch::daemon {

/// model.toml: the configuration with the identified values as its design and the effects as
/// [[effect]].
std::string diagnosis_model_toml(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
