// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace framewatch::daemon {

/// Returns the median of the known times, the later one of two middle ones. One wrong clock does
/// not move it. A time that equals `unknown` does not count; without others the result is
/// `unknown`.
inline std::int64_t usual_time_us(std::vector<std::int64_t> times_us, std::int64_t unknown) {
  std::erase(times_us, unknown);
  if (times_us.empty()) return unknown;
  const auto middle = times_us.begin() + static_cast<std::ptrdiff_t>(times_us.size() / 2);
  std::nth_element(times_us.begin(), middle, times_us.end());
  return *middle;
}

}  // namespace framewatch::daemon
