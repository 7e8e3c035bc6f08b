#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_output.h"

namespace framewatch::daemon {

/// What sort of force the likeliest element needs, whatever its law, in one sentence; empty where
/// none was looked at or a linear element does.
std::string kind_sentence(const DiagnoseOutput& output);

/// The same with its picture: the force beyond a linear element over deformation, and its means
/// over deformation and over rate. Empty where kind_sentence() is.
std::string kind_section(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
