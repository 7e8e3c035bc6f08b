#pragma once

#include <chrono>
#include <cstdint>

namespace framewatch::daemon {

inline constexpr std::int64_t kSecond_us = 1'000'000;
inline constexpr std::int64_t kDay_us = 86'400 * kSecond_us;

/// The time of a clock, microseconds since its epoch.
template <typename Clock>
std::int64_t clock_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
      .count();
}

/// The time of day; it jumps when somebody sets the clock.
inline std::int64_t host_clock_us() {
  return clock_us<std::chrono::system_clock>();
}

/// A clock that is never set: it only goes forward.
inline std::int64_t steady_clock_us() {
  return clock_us<std::chrono::steady_clock>();
}

/// Says when something that is done once a second is due, by the host's clock; at once when that
/// clock was set back.
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
