#pragma once

#include <chrono>
#include <cstdint>
#include <ratio>
#include <thread>

namespace framewatch::daemon {

/// Waits until an event's time has come, at `speed` times real time. A step back or of more than
/// kLongest_us, the night between two logs, is not waited for.
class Pace {
 public:
  explicit Pace(double speed) : speed_(speed) {}
  void wait_for(std::int64_t time_us) {
    if (speed_ <= 0) return;
    std::int64_t step_us = 0;
    const bool usual = started_ && !__builtin_sub_overflow(time_us, newest_us_, &step_us) &&
                       step_us >= 0 && step_us <= kLongest_us;
    if (usual)
      due_ += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
          std::chrono::duration<double, std::micro>(static_cast<double>(step_us) / speed_));
    started_ = true;
    newest_us_ = time_us;
    std::this_thread::sleep_until(due_);
  }

 private:
  static constexpr std::int64_t kLongest_us = 10'000'000;
  double speed_;
  bool started_ = false;
  std::int64_t newest_us_ = 0;
  std::chrono::steady_clock::time_point due_ = std::chrono::steady_clock::now();
};

}  // namespace framewatch::daemon
