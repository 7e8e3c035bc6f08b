#pragma once

#include <chrono>

#include "estimator/identify/estimate/estimate.h"

namespace framewatch::estimator {

inline double seconds_of(Time time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

inline double seconds_of(SensorClock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Selects the windows to learn from: valid ones that do not overlap, so that their errors are
/// nearly independent.
class SeparateWindows {
 public:
  /// Whether this window is selected; it then counts.
  bool take(const WindowEstimate& e) {
    if (e.status != WindowStatus::valid || (count_ > 0 && e.start <= end_)) return false;
    end_ = e.end;
    ++count_;
    seconds_ += length_s(e);
    return true;
  }
  static double length_s(const WindowEstimate& e) {
    return std::chrono::duration<double>(e.end - e.start).count();
  }
  double seconds() const { return seconds_; }
  /// Whether at least half of them are `count`.
  bool most(int count) const { return count > 0 && 2 * count >= count_; }

  template <typename Archive>
  void archive(Archive& a) {
    a.within(count_, 0, a.kMaxCount);
    a.within(seconds_, 0, a.kMaxCount);
    a(end_);
  }

 private:
  int count_ = 0;
  double seconds_ = 0;
  Time end_{};
};

}  // namespace framewatch::estimator
