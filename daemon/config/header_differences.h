// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/records/record.h"

namespace framewatch::daemon {

/// Returns one sentence for each difference between a record's headers and the configured channels
/// it has: direction, polarity, level or unit, with its consequence. Without azimuth_y_deg the
/// azimuth that most headers agree with is used. Levels are compared with the network's usual
/// numbering. Empty if they agree or there are no headers.
std::vector<std::string> header_differences(const Config& config, const drivers::Record& record);

}  // namespace framewatch::daemon
