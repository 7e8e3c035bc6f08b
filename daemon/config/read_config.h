#pragma once

#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Returns true if the document describes a virtual test (`framewatch simulate`).
bool is_scenario(const TomlValue& document);

/// The configuration in a document that was parsed already; its path is set, its digest and the
/// files it names beside DBC files are not touched. False when there was a problem.
bool read_config(const TomlValue& document, Config& config, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
