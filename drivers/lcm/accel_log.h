// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// Writes a record as an LCM event log of accel_t, with the channel_table_t before the first
/// instant and every second. Sensor time, which is also the time of the events, is start_us +
/// time_s. `addresses` are parallel to the names of the record. `progress` gets the share written
/// so far, 0 to 1. Returns an empty string, or what went wrong.
std::string write_accel_log(const std::string& path, const Record& record,
                            const std::vector<AxisAddress>& addresses, std::int64_t start_us,
                            const std::function<void(double)>& progress = {});

/// The channels of an event log, by the type of their first message.
struct LogContents {
  std::vector<std::string> accel;      ///< channels of accel_t
  std::vector<std::string> estimates;  ///< channels of window_estimate_t
  std::vector<std::string> others;
  std::vector<std::string> reasons;  ///< of `others`: why the first message is not an accel_t
  std::int64_t events = 0;
};

/// Reads a log to its end. Returns nullopt and appends the problems when it cannot be read, is
/// damaged or cut off, or holds no event.
std::optional<LogContents> log_contents(const std::string& path, std::vector<Problem>& problems);

/// Returns the accelerations on one channel of a log as a record. The axes are those of its
/// channel_table_t in that order, or "node<k>.<axis>" for every axis that ever has a value. Samples
/// may come in any order. A repeated sample counts once and an infinite one is missing; both are
/// noted. Time is that of the sensors. Returns nullopt and appends the problems when the log cannot
/// be read or its messages break a rule.
std::optional<Record> read_accel_log(const std::string& path, const std::string& channel,
                                     std::vector<Problem>& problems);

}  // namespace framewatch::drivers
