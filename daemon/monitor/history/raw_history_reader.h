// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/monitor/history/history_files.h"
#include "drivers/lcm/count_block.h"
#include "drivers/lcm/lcm_log.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {

struct RawCount {
  std::int64_t time_us;
  std::size_t channel;  ///< index in the newest table
  std::int32_t count;   ///< as in accel_counts_t
  double resolution_mps2;
  /// Returns the acceleration before calibration; NaN for an invalid value.
  double accel_mps2() const {
    return count == drivers::kNoCount ? estimator::kNaN : count * resolution_mps2;
  }
};

/// Receives the content of raw logs.
struct RawVisitor {
  /// Called before the first sample and whenever the channels change.
  std::function<void(const std::vector<std::string>& names, double rate_hz)> channels;
  std::function<void(const RawCount&)> sample;
  /// Gets messages other than samples; may be empty.
  std::function<void(const drivers::LogEvent&)> message = {};
};

/// Returns the raw logs of a directory that may hold samples of [from_us, to_us), including those
/// kept for events, in order of time.
std::vector<RawLog> raw_logs_between(const std::string& directory, std::int64_t from_us,
                                     std::int64_t to_us);

/// Returns the index of the axis by channel of the log; -1 for a channel without an axis.
std::vector<int> axes_of(const std::vector<std::string>& channels,
                         const std::vector<estimator::SensorAxis>& axes);

/// Reads their samples in the order in which they were received. Reads the intact part of a log
/// that is being written, truncated or damaged, and adds a note. Returns false and sets `problem`
/// when a log cannot be read.
bool read_raw_history(const std::vector<RawLog>& logs, std::int64_t from_us, std::int64_t to_us,
                      const RawVisitor& visitor, std::vector<std::string>& notes,
                      std::string& problem);

}  // namespace framewatch::daemon
