#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/config/sections/config_problems.h"

namespace framewatch::daemon {

/// What looks at a parsed document, and says what is wrong with it.
using TomlReader = std::function<void(const TomlValue&, std::vector<TextProblem>&)>;

/// Lets `read` look at a text; `path` is what messages call it. False when anything was wrong, with
/// every problem added.
bool read_toml(const std::string& path, const std::string& text, const TomlReader& read,
               std::vector<ConfigProblem>& problems);
/// The same of a file.
bool read_toml_file(const std::string& path, const TomlReader& read,
                    std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
