#include "drivers/can/host_clock.h"

#include <time.h>

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
  timespec day{}, steady{};
  ::clock_gettime(CLOCK_REALTIME, &day);
  ::clock_gettime(CLOCK_MONOTONIC, &steady);
  return 1'000'000 * (day.tv_sec - steady.tv_sec) + (day.tv_nsec - steady.tv_nsec) / 1000;
}

}  // namespace framewatch::drivers
