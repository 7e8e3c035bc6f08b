// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_verdict.h"

namespace framewatch::daemon {

/// Draws the search as HTML: what the linear model, an arbitrary force at every place, every law
/// that was fitted, and the laws that were kept leave unexplained. Returns "" if nothing was
/// searched.
std::string search_section(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
