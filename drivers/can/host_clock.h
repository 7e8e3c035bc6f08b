#pragma once

#include <cstdint>

namespace framewatch::drivers {

/// The clock of the day beside the monotonic one.
struct HostClockReading {
  std::int64_t day_us = 0;
  std::int64_t offset_us = 0;    ///< of the day minus monotonic
  std::int64_t doubtful_us = 0;  ///< how far off `offset_us` may be
};
HostClockReading read_host_clock();

/// Takes the steps of the host's clock out of the receive stamps of one bus: what it says is
/// continuous with the clock at the start. Pure: the readings are the caller's, made after the
/// frames were received and before their stamps are asked for.
class ContinuousStamps {
 public:
  void now(const HostClockReading& reading);
  /// Nothing was left to receive after the last reading.
  void drained() { drained_us_ = newest_us_; }
  /// The stamp without the clock's steps. It may be from before a step that was noticed only after
  /// it was made, so both offsets are possible. The one is taken that puts it after the bus was
  /// last drained and not into the future; if both do, the one nearer to the last stamp.
  std::int64_t continuous(std::int64_t stamp_us);
  std::int64_t steps() const { return steps_; }

 private:
  static constexpr std::int64_t kStep_us = 20'000;  ///< less is slewing

  bool started_ = false;
  std::int64_t offset_us_ = 0;  ///< of the last reading
  std::int64_t total_us_ = 0;   ///< of the steps so far
  std::int64_t before_us_ = 0;  ///< likewise, before the last one
  std::int64_t newest_us_ = 0;  ///< the last reading, continuous
  std::int64_t drained_us_ = 0;
  std::int64_t last_us_ = 0;  ///< what continuous() said last
  std::int64_t steps_ = 0;
};

}  // namespace framewatch::drivers
