// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "tests/soak/soak_night.h"

namespace framewatch::soak {

struct SoakOptions {
  double days = 30;
  std::string directory;         ///< of the history
  double quiet_window_s = 3600;  ///< [watch]
  double quiet_learn_hours = 96;
  double alarms_per_year = 120;   ///< largest accepted number of false alarms
  std::int64_t rotate_s = 86400;  ///< of the raw logs
  std::int64_t summary_s = 60;    ///< the shortest period of the summaries
  std::uint64_t seed = 1;
  /// Called at each reading of memory: days, resident memory, false alarms so far.
  std::function<void(double, std::int64_t, int)> looked;
};

struct SoakResult {
  std::int64_t instants = 0, samples = 0;
  double wall_s = 0;
  /// Resident memory at rotations of the raw logs, when little is waiting to be written. At a
  /// thousand times the real pace, the writers' buffers are a thousand times too large.
  std::vector<std::int64_t> resident;
  /// The maximum after the first fifth over the maximum until then.
  std::int64_t growth() const;
  // Windows.
  std::int64_t windows = 0, expected_windows = 0, breaks = 0;
  std::int64_t long_windows = 0, long_values = 0;
  /// Largest relative difference between a window's normal solution and that of a pipeline that
  /// saw only the last minutes, at five times; and the number of times without such a solution.
  double sum_error = 0;
  int sums_compared = 0;
  // The history.
  std::string history_trouble;  ///< empty if none
  std::int64_t summarised_windows = 0, hourly_windows = 0, raw_dropped = 0, summary_dropped = 0;
  // False changes.
  int alarms = 0;
  std::vector<std::string> told;
};

/// Returns the configuration of the soak's building.
daemon::Config configuration(const SoakOptions& options);

SoakResult run_soak(const SoakOptions& options);

}  // namespace framewatch::soak
