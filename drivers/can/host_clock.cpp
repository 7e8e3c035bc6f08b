#include "drivers/can/host_clock.h"

#include <time.h>

#include <cstdint>
#include <cstdlib>

namespace framewatch::drivers {

bool ContinuousStamps::now(std::int64_t offset_us) {
  const std::int64_t change_us = offset_us - offset_us_;
  const bool first = !started_;
  started_ = true;
  offset_us_ = offset_us;
  if (first || std::abs(change_us) < kStep_us) return false;
  before_us_ = total_us_;
  total_us_ += change_us;
  ++steps_;
  return true;
}

std::int64_t ContinuousStamps::continuous(std::int64_t stamp_us) {
  const std::int64_t after = stamp_us - total_us_, before = stamp_us - before_us_;
  const bool earlier =
      steps_ > 0 && std::abs(before - last_us_) < std::abs(after - last_us_) && last_us_ != 0;
  last_us_ = earlier ? before : after;
  return last_us_;
}

std::int64_t host_clock_offset_us() {
  constexpr int kTries = 20;
  constexpr std::int64_t kClose_us = 20;
  const auto read = [](clockid_t clock) {
    timespec time{};
    ::clock_gettime(clock, &time);
    return 1'000'000 * std::int64_t{time.tv_sec} + time.tv_nsec / 1000;
  };
  // The process may lose its processor between two readings, which must not look like a step.
  std::int64_t offset_us = 0, closest_us = INT64_MAX;
  for (int i = 0; i < kTries && closest_us > kClose_us; ++i) {
    const std::int64_t before = read(CLOCK_MONOTONIC), day = read(CLOCK_REALTIME);
    const std::int64_t apart = read(CLOCK_MONOTONIC) - before;
    if (apart >= closest_us) continue;
    closest_us = apart;
    offset_us = day - before - apart / 2;
  }
  return offset_us;
}

}  // namespace framewatch::drivers
