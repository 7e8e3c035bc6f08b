// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/files/file_problems.h"

namespace framewatch::python {

/// Becomes framewatch.Error, a ValueError, with the same text.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws an Error with one line per problem.
[[noreturn]] void refuse(const std::vector<std::string>& problems);
[[noreturn]] void refuse(const std::vector<daemon::ConfigProblem>& problems);
[[noreturn]] void refuse(const std::vector<drivers::Problem>& problems);

/// Returns each problem as "place: rule".
std::vector<std::string> lines_of(const std::vector<daemon::ConfigProblem>& problems);

}  // namespace framewatch::python
