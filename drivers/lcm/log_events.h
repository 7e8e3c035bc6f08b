#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// Gives every event of a log to `take` until it returns false. False, with the problem, when the
/// log cannot be read, is damaged or cut off: an offline command stops at damage.
bool for_each_event(const std::string& path, const std::function<bool(const LogEvent&)>& take,
                    std::vector<Problem>& problems);

/// "PATH: event 17 (byte 1234)", for messages.
std::string place_of(const std::string& path, const LogEvent& event);

}  // namespace framewatch::drivers
