#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace framewatch::daemon {

/// A histogram of durations.
class DurationCounts {
 public:
  /// Upper limits, s.
  static constexpr std::array kLimit_s = {1e-5,
                                          2.5e-5,
                                          5e-5,
                                          1e-4,
                                          2.5e-4,
                                          5e-4,
                                          1e-3,
                                          2.5e-3,
                                          5e-3,
                                          1e-2,
                                          2.5e-2,
                                          5e-2,
                                          1e-1,
                                          2.5e-1,
                                          5e-1,
                                          1.0,
                                          std::numeric_limits<double>::infinity()};

  void add(double seconds) {
    const auto limit = std::lower_bound(kLimit_s.begin(), kLimit_s.end() - 1, seconds);
    ++counts_[static_cast<std::size_t>(limit - kLimit_s.begin())];
    sum_s_ += seconds;
  }
  const std::array<std::int64_t, kLimit_s.size()>& counts() const { return counts_; }
  double sum_s() const { return sum_s_; }

 private:
  std::array<std::int64_t, kLimit_s.size()> counts_{};
  double sum_s_ = 0;
};

/// How punctual a live process is.
struct LiveTimes {
  DurationCounts steps;                 ///< time spent on each message or frame
  DurationCounts latencies;             ///< from the arrival of a sample to its estimate
  std::int64_t deadline_missed = 0;     ///< estimates later than the hop between two
  std::int64_t received_us = 0;         ///< host clock, of the newest sample; 0: none has come
  std::vector<std::int64_t> newest_us;  ///< sensor time, of each axis; 0: none has come
};

}  // namespace framewatch::daemon
