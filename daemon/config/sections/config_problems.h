// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/base/toml_document.h"

namespace framewatch::daemon {

struct ConfigProblem {
  std::string where;  ///< file:line:column, or file
  std::string message;
};

/// Returns the problems of a text as problems of its file, ordered by place.
std::vector<ConfigProblem> with_file(const std::string& path, std::vector<TextProblem> problems);

/// Prints the first 20 problems, each as a line on stderr, and the number of the others.
void print_problems(const std::vector<ConfigProblem>& problems);
/// Logs warnings about values that are allowed but implausible.
void log_doubts(const std::vector<ConfigProblem>& doubts);

/// Checks a parsed document and appends its problems.
using TomlReader = std::function<void(const TomlValue&, std::vector<TextProblem>&)>;

/// Parses a text and passes it to `read`. Appends every problem and returns false if there is any.
/// `path` is the file name in messages.
bool read_toml(const std::string& path, const std::string& text, const TomlReader& read,
               std::vector<ConfigProblem>& problems);
/// Does the same with a file.
bool read_toml_file(const std::string& path, const TomlReader& read,
                    std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
