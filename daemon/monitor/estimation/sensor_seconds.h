#pragma once

#include <cstdint>

#include "daemon/base/clocks.h"

namespace framewatch::daemon {

/// Tells when a second of sensor time has passed. A single node whose clock jumps does not move it;
/// kStraysToFollow samples in a row do.
class SensorSeconds {
 public:
  /// True for the first sample and for the first one of each further second.
  bool passed(std::int64_t time_us);
  std::int64_t newest_us() const { return newest_us_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_);
    for (std::int64_t* us : {&newest_us_, &next_us_})
      a.within(*us, -2 * a.kMaxCount, 2 * a.kMaxCount + kSecond_us);
    a.within(strays_, 0, kStraysToFollow);
  }

 private:
  static constexpr std::int64_t kLargestStep_us = 10 * kSecond_us;
  static constexpr int kStraysToFollow = 1000;  ///< in a row

  bool started_ = false;
  std::int64_t newest_us_ = 0;
  std::int64_t next_us_ = 0;
  int strays_ = 0;
};

}  // namespace framewatch::daemon
