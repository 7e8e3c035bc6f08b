#include "daemon/monitor/estimation/sensor_seconds.h"

namespace framewatch::daemon {

bool SensorSeconds::passed(std::int64_t time_us) {
  std::int64_t step = 0;
  const bool near = started_ && !__builtin_sub_overflow(time_us, newest_us_, &step) &&
                    step <= kLargestStep_us && step >= -kLargestStep_us;
  if (!started_ || (!near && ++strays_ >= kStraysToFollow)) {
    started_ = true;
    strays_ = 0;
    newest_us_ = time_us;
    next_us_ = time_us > INT64_MAX - kSecond_us ? INT64_MAX : time_us + kSecond_us;
    return true;
  }
  if (!near) return false;
  strays_ = 0;
  if (step <= 0) return false;
  newest_us_ = time_us;
  if (newest_us_ < next_us_) return false;
  while (next_us_ <= newest_us_ && next_us_ <= INT64_MAX - kSecond_us) next_us_ += kSecond_us;
  return true;
}

}  // namespace framewatch::daemon
