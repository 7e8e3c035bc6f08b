// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/record_file_arguments.h"
#include "daemon/config/config.h"
#include "drivers/files/file_problems.h"
#include "drivers/lcm/accel_log.h"
#include "drivers/records/record.h"

namespace framewatch::daemon {

/// Gets each line about values that are allowed but implausible.
using Warn = std::function<void(const std::string& doubt)>;

/// Returns true if `convert` reads the file as an LCM event log, otherwise as a record.
bool is_log_to_convert(const std::string& path);

/// Reads record files of one motion and merges their axes over the common time. `config`: for
/// plausible ranges and the rate, or null. `devices` is set to true if each file is that of one
/// device: the axes are then node0.x, node0.y, ..., and time starts at 0. Returns nullopt and
/// appends the problems if there are any.
std::optional<drivers::Record> read_merged(const std::vector<std::string>& inputs,
                                           const RecordFileArguments& arguments,
                                           const Config* config, bool& devices, const Warn& warn,
                                           std::vector<drivers::Problem>& problems);

/// Returns the channel that was asked for, or else the only one of `found`; otherwise an empty
/// text.
std::string chosen_channel(const std::vector<std::string>& found, const std::string& asked);
/// Returns why a log has not exactly one channel to convert.
std::string no_channel(const drivers::LogContents& contents, const std::string& asked);
/// Returns names for a message, or "none".
std::string listed_channels(const std::vector<std::string>& names);

/// Reads the accelerations on one channel of an event log. Impossible values are warnings, because
/// a log cannot be corrected by hand. Returns nullopt and appends the problems if there are any.
std::optional<drivers::Record> read_doubted_log(const std::string& path, const std::string& channel,
                                                const Warn& warn,
                                                std::vector<drivers::Problem>& problems);

/// Reads all that `convert` reads as accelerations: record files of one motion, or one event log.
/// `channel`: LCM channel of the log, or empty for its only one. Returns nullopt and appends the
/// problems if there are any.
std::optional<drivers::Record> read_to_convert(const std::vector<std::string>& inputs,
                                               const RecordFileArguments& arguments,
                                               const std::string& channel, const Warn& warn,
                                               std::vector<drivers::Problem>& problems);

}  // namespace framewatch::daemon
