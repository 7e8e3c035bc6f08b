#pragma once

#include <string>
#include <vector>

#include "drivers/record.h"

namespace framewatch::daemon {

/// Writes the window_estimate_t on `channel` of a log as estimates CSV (docs/formats.md), .gz when
/// the name says so, with the parameter_table_t of the same log. False, with every problem and no
/// file, when the log is damaged, has no table or holds a message that breaks its type's rules.
bool write_estimates_csv(const std::string& log, const std::string& channel, bool boxplot,
                         const std::string& out, std::vector<drivers::Problem>& problems);

}  // namespace framewatch::daemon
