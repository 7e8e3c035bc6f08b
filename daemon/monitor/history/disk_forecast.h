// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/config/keys/history_options.h"

namespace framewatch::daemon {

/// Size of a history and its growth.
struct HistoryGrowth {
  double raw_bytes = 0;            ///< closed raw logs; bounded by keep_days and keep_gb
  double raw_bytes_per_day = 0;    ///< before old logs are deleted
  double other_bytes_per_day = 0;  ///< summaries and raw samples of events, which stay
  double free_bytes = 0;           ///< on the disk
};

/// Returns the days until the disk is full if the history grows on as before and nothing else does;
/// nullopt if that takes longer than 10 years.
std::optional<double> days_until_full(const HistorySettings& settings, const HistoryGrowth& growth);

/// Reads the growth from the stored files. Returns nullopt if they cannot be read, or cover less
/// than an hour. `now_us`: host clock.
std::optional<HistoryGrowth> history_growth(const HistorySettings& settings, std::int64_t now_us);

/// Returns "the disk is full in about 40 days (2027-01-07)" or "the disk has room for 10 years or
/// more".
std::string disk_sentence(std::optional<double> days, std::int64_t now_us);

}  // namespace framewatch::daemon
