// SPDX-License-Identifier: MIT
#pragma once

#include <ctime>

#include <cstddef>
#include <vector>

#include "estimator/numeric/quantile.h"

namespace framewatch::bench {

/// CPU time of this thread, us. Time of other processes does not count.
inline double cpu_us() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

/// Elapsed time, us, read without a system call.
inline double wall_us() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

/// Median time between two consecutive readings of the clock, us.
inline double cpu_clock_cost_us() {
  std::vector<double> cost;
  for (int i = 0; i < 1001; ++i) {
    const double before = cpu_us();
    cost.push_back(cpu_us() - before);
  }
  return estimator::upper_median(cost);
}

/// Returns the value below which `share` of the values lie.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const double rank = share * static_cast<double>(values.size() - 1);
  return estimator::ranked(values, static_cast<std::size_t>(rank));
}

}  // namespace framewatch::bench
