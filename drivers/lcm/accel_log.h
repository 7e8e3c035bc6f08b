#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/lcm/accel_messages.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// Writes a record as an LCM event log of accel_t, with the channel_table_t before the first
/// instant and every second. Sensor time, which is also the events' time, is start_us + time_s;
/// `addresses` is parallel to the record's names; `progress` hears the share that is written. Empty
/// on success, else what went wrong.
std::string write_accel_log(const std::string& path, const Record& record,
                            const std::vector<AxisAddress>& addresses, std::int64_t start_us,
                            const std::function<void(double)>& progress = {});

/// What an event log holds, by the types its channels' first messages have.
struct LogContents {
  std::vector<std::string> accel;      ///< channels of accel_t
  std::vector<std::string> estimates;  ///< channels of window_estimate_t
  std::vector<std::string> others;
  std::int64_t events = 0;
};

/// Reads a log to its end. Empty, with the problems, when it cannot be read, is damaged or cut off
/// or holds no event.
std::optional<LogContents> log_contents(const std::string& path, std::vector<Problem>& problems);

/// The accelerations on one channel of a log as a record: columns as its channel_table_t names them
/// and in its order, else "node<k>.<axis>" for every axis that ever has a value. Samples may come
/// in any order; a repeated one counts once, an infinite one is missing; both are noted. Time is
/// the sensors'.
std::optional<Record> read_accel_log(const std::string& path, const std::string& channel,
                                     std::vector<Problem>& problems);

}  // namespace framewatch::drivers
