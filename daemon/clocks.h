#pragma once

#include <chrono>
#include <cstdint>

namespace framewatch::daemon {

inline constexpr std::int64_t kSecond_us = 1'000'000;
inline constexpr std::int64_t kDay_us = 86'400 * kSecond_us;

/// The clock's time, microseconds since its epoch.
template <typename Clock>
std::int64_t clock_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
      .count();
}

/// Of the day, which may be set.
inline std::int64_t host_clock_us() {
  return clock_us<std::chrono::system_clock>();
}

/// Never set.
inline std::int64_t steady_clock_us() {
  return clock_us<std::chrono::steady_clock>();
}

}  // namespace framewatch::daemon
