// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

namespace framewatch::daemon {

inline constexpr std::int64_t kSecond_us = 1'000'000;
inline constexpr std::int64_t kDay_us = 86'400 * kSecond_us;

/// Returns the time of a clock in microseconds since its epoch.
template <typename Clock>
std::int64_t clock_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
      .count();
}

/// Returns the time of day in microseconds. It jumps when the clock is set.
inline std::int64_t host_clock_us() {
  return clock_us<std::chrono::system_clock>();
}

/// Returns microseconds of a clock that only moves forward.
inline std::int64_t steady_clock_us() {
  return clock_us<std::chrono::steady_clock>();
}

/// Decides when work that happens once a second is due, by the host's clock. The work is due at
/// once after that clock was set back.
class OnceASecond {
 public:
  bool due(std::int64_t now_us) {
    if (now_us < next_us_ && next_us_ <= now_us + kSecond_us) return false;
    next_us_ = now_us + kSecond_us;
    return true;
  }

 private:
  std::int64_t next_us_ = INT64_MIN;
};

}  // namespace framewatch::daemon
