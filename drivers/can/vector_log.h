// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_log.h"
#include "drivers/files/file_problems.h"

// Readers of the logs of Vector's CANoe, CANalyzer and loggers. Both formats number the channels
// from 1: channel 1 counts as the interface can0, as `asc2log` has it. Both have the local date of
// the start: `zone_min` is that time minus UTC in minutes. Without a zone the date counts as UTC,
// without a date the times begin at 0; `notes` get a sentence about either. A reader returns false
// and appends at most 20 problems for what is malformed, which it skips.

namespace framewatch::drivers {

/// Returns true if a file has the header of a text log (.asc): "base hex  timestamps absolute" or
/// similar in its first lines.
bool looks_like_asc(const std::string& path);

/// Calls `take` for the frames of a text log, plain or gzip: data, remote and error frames of CAN
/// and CAN FD channels that were received or sent. Skips all other events.
bool read_asc(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
              std::vector<std::string>& notes, std::vector<Problem>& problems);

/// Returns true if a file begins like a binary log (.blf).
bool looks_like_blf(const std::string& path);

/// Calls `take` for the frames of a binary log, as read_asc() does. Holds at most one container of
/// 16 MiB in memory.
bool read_blf(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
              std::vector<std::string>& notes, std::vector<Problem>& problems);

/// The date of a log's start.
struct LogDate {
  int year = 0, month = 0, day = 0;
  int hour = 0, minute = 0, second = 0, millisecond = 0;
};

/// Returns the start in microseconds UTC. Returns 0 when `date` is empty or no date from 1970 to
/// 2200, and adds a note when date or zone is missing.
std::int64_t start_of_log(const std::optional<LogDate>& date, std::optional<int> zone_min,
                          std::vector<std::string>& notes);

/// Returns the interface of a channel, counted from 1: "can0" for 1.
std::string interface_of_channel(unsigned channel);

/// Returns the data bytes of a frame by its data length code of four bits.
int bytes_of_code(unsigned code, bool fd);

/// Returns an error frame without details.
CanFrame plain_error_frame(std::int64_t stamp_us);

}  // namespace framewatch::drivers
