// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "drivers/records/record_options.h"

namespace framewatch::drivers {

/// Reads a record file, plain or gzip, and finds its format from its content unless the options
/// give it. Time is the file's own: the device clock for Xsens, from 0 when the file has no time.
/// Lost samples are filled with NaN and noted when they leave out whole steps. A channel without a
/// name gets that of the file. Returns nullopt and appends every problem as file:line (at most 20)
/// when the file breaks a rule of its format.
std::optional<Record> read_record(const std::string& path, const RecordOptions& options,
                                  std::vector<Problem>& problems);

/// Returns true if a file has a format of strong-motion networks (drivers/stations).
bool is_network_file(const std::string& path);

}  // namespace framewatch::drivers
