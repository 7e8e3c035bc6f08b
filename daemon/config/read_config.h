// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Returns true if the document describes a virtual test (`framewatch simulate`).
bool is_scenario(const TomlValue& document);

/// Reads a configuration from a parsed document. `config` must have its path. Does not set the
/// digest and reads only DBC files of the files it names. Returns false and appends the problems if
/// there are any.
bool read_config(const TomlValue& document, Config& config, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
