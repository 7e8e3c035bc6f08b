#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/records/record.h"

namespace framewatch::daemon {

/// What the headers of a record say otherwise than the configuration of the channels it has, a
/// sentence each with what follows from it: direction, polarity, level, unit. Where the building's
/// azimuth_y_deg is not given, the one that most headers agree with is taken; levels are compared
/// up to how the network counts them, as most of its headers do. Empty: they agree, or there are
/// no headers.
std::vector<std::string> header_differences(const Config& config, const drivers::Record& record);

}  // namespace framewatch::daemon
