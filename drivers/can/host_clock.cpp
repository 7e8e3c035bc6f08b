#include "drivers/can/host_clock.h"

#include <time.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace framewatch::drivers {

void ContinuousStamps::now(const HostClockReading& reading) {
  // A doubtful reading would make a step of nothing, and another one back.
  if (started_ && reading.doubtful_us > kStep_us / 4) return;
  const std::int64_t change_us = reading.offset_us - offset_us_;
  const bool step = started_ && std::abs(change_us) >= kStep_us;
  started_ = true;
  offset_us_ = reading.offset_us;
  if (step) {
    before_us_ = total_us_;
    total_us_ += change_us;
    ++steps_;
  }
  newest_us_ = reading.day_us - total_us_;
}

std::int64_t ContinuousStamps::continuous(std::int64_t stamp_us) {
  const std::int64_t after = stamp_us - total_us_, before = stamp_us - before_us_;
  const std::int64_t oldest = std::max(last_us_, drained_us_) - kStep_us;
  const auto possible = [&](std::int64_t us) {
    return us >= oldest && us <= newest_us_ + kStep_us;
  };
  const bool nearer = std::abs(before - last_us_) < std::abs(after - last_us_);
  const bool earlier =
      steps_ > 0 && (possible(before) == possible(after) ? nearer : possible(before));
  last_us_ = earlier ? before : after;
  return last_us_;
}

HostClockReading read_host_clock() {
  constexpr int kTries = 20;
  constexpr std::int64_t kClose_us = 20;
  const auto read = [](clockid_t clock) {
    timespec time{};
    ::clock_gettime(clock, &time);
    return 1'000'000 * std::int64_t{time.tv_sec} + time.tv_nsec / 1000;
  };
  // The process may lose its processor between two readings, which must not look like a step.
  HostClockReading closest{0, 0, INT64_MAX};
  for (int i = 0; i < kTries && closest.doubtful_us > kClose_us; ++i) {
    const std::int64_t before = read(CLOCK_MONOTONIC), day = read(CLOCK_REALTIME);
    const std::int64_t apart = read(CLOCK_MONOTONIC) - before;
    if (apart < closest.doubtful_us) closest = {day, day - before - apart / 2, apart};
  }
  return closest;
}

}  // namespace framewatch::drivers
