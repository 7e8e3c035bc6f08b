#pragma once

#include <vector>

#include "daemon/config.h"

namespace framewatch::daemon {

/// All of them on stderr, a line each.
void print_problems(const std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
