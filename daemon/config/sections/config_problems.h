#pragma once

#include <string>
#include <vector>

#include "daemon/base/toml_document.h"

namespace framewatch::daemon {

struct ConfigProblem {
  std::string where;  ///< file:line:column, or file
  std::string message;
};

/// Problems of a text as problems of its file, in order of place.
std::vector<ConfigProblem> with_file(const std::string& path, std::vector<TextProblem> problems);

/// All of them on stderr, a line each.
void print_problems(const std::vector<ConfigProblem>& problems);
/// The same of what is allowed and hardly meant, as log lines.
void log_doubts(const std::vector<ConfigProblem>& doubts);

}  // namespace framewatch::daemon
