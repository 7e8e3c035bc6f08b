#pragma once

#include <vector>

#include "daemon/config/settings.h"
#include "daemon/documents/toml_document.h"

namespace framewatch::daemon {

/// The configuration in a document that was parsed already; its path is set, its digest and the
/// files it names beside DBC files are not touched. False when there was a problem.
bool read_config(const TomlValue& document, Config& config, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
