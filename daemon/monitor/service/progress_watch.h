// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>

#include "estimator/pipeline/pipeline.h"

namespace framewatch::daemon {

/// Tells whether the estimator makes progress: accepted samples must become instants. An estimator
/// without samples is idle, which is healthy.
class ProgressWatch {
 public:
  /// No sample waits longer than this for the others of its instant.
  static constexpr std::int64_t kLongest_us = 5'000'000;
  /// After this time without a sample the estimator is idle.
  static constexpr std::int64_t kIdle_us = 1'000'000;

  /// Returns false if samples have waited for an instant for longer than kLongest_us. `now_us`:
  /// steady clock.
  bool well(const estimator::PipelineCounters& counters, std::int64_t now_us) {
    std::int64_t accepted = 0;
    for (const estimator::AxisCounters& axis : counters.axes)
      accepted += axis.received - axis.late - axis.rejected;
    const bool idle = now_us - accepted_us_ > kIdle_us;
    if (idle || std::exchange(sets_, counters.sample_sets) != counters.sample_sets)
      waiting_since_us_ = now_us;
    if (std::exchange(accepted_, accepted) != accepted) accepted_us_ = now_us;
    return now_us - waiting_since_us_ <= kLongest_us;
  }

 private:
  std::int64_t sets_ = -1, accepted_ = -1;
  std::int64_t accepted_us_ = 0, waiting_since_us_ = 0;
};

}  // namespace framewatch::daemon
