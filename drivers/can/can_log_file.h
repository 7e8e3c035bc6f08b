// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_log.h"
#include "drivers/files/file_problems.h"

namespace framewatch::drivers {

/// The formats of logs of CAN frames that are read.
enum class CanLogFormat { none, candump, asc, blf };

/// Returns the format that a file begins like.
CanLogFormat can_log_format(const std::string& path);

/// Calls `take` for every frame of a log. `zone_min` is for logs with a local date (ASC, BLF):
/// local time minus UTC. Returns false when there was a problem. Skips what is malformed, and
/// appends a problem for the first 20. Adds to `notes` what is unknown about the times.
bool read_can_log(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
                  std::vector<std::string>& notes, std::vector<Problem>& problems);

/// Returns what a log of CAN frames is that is not read, and what to do: "is a PCAN trace (TRC),
/// ...". Returns an empty text for other files.
std::string unread_can_log(const std::string& path);

}  // namespace framewatch::drivers
