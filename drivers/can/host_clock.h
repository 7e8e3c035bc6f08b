#pragma once

#include <cstdint>

namespace framewatch::drivers {

/// Takes the steps of the host's clock out of receive stamps: what it says is continuous with the
/// clock at the start. Pure: the readings are the caller's.
class ContinuousStamps {
 public:
  /// Clock of the day minus the monotonic one, now, microseconds. True when that is a step.
  bool now(std::int64_t offset_us);
  /// Stamps may be from before a step that was noticed after them: the newest one's neighbour wins.
  std::int64_t continuous(std::int64_t stamp_us);
  std::int64_t steps() const { return steps_; }

 private:
  static constexpr std::int64_t kStep_us = 20'000;  ///< less is slewing

  bool started_ = false;
  std::int64_t offset_us_ = 0;  ///< now
  std::int64_t total_us_ = 0;   ///< of the steps so far
  std::int64_t before_us_ = 0;  ///< likewise, before the last one
  std::int64_t last_us_ = 0;    ///< what continuous() said last
  std::int64_t steps_ = 0;
};

/// Clock of the day minus the monotonic clock, microseconds.
std::int64_t host_clock_offset_us();

}  // namespace framewatch::drivers
