#pragma once

#include <cstdint>
#include <vector>

#include "estimator/gap/gap.h"

namespace framewatch::estimator {

/// Sums simulation and measurement second by second, and compares them over the last window_s.
class GapMeter {
 public:
  /// compared: of every axis, whether it is. rate_hz: of the instants.
  GapMeter(const std::vector<char>& compared, double rate_hz, int window_s);

  void restart();
  /// One axis at the present instant, m/s^2; not called for an axis without a value.
  void add(std::size_t axis, double measured, double simulated);
  /// The present instant is the last of a second: close() will need the noise.
  bool ends_second() const { return instants_ + 1 >= per_second_; }
  /// Ends the instant. True when it ends a second and the window is full; gap() is then of it.
  bool close(Time time, const std::vector<double>& noise_variance);
  const GapWindow& gap() const { return gap_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(seconds_, gap_);
    a.within(newest_, 0, window_s_ - 1);
    a.within(full_, 0, window_s_);
    a.within(instants_, 0, per_second_);
  }

 private:
  struct Sum {
    double difference = 0, measured = 0;  ///< of squares
    std::int64_t count = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a.finite(difference, measured);
      a.within(count, 0, a.kMaxCount);
    }
  };
  void compare(const std::vector<double>& noise_variance);
  Sum& of(int second, std::size_t axis) {
    return seconds_[static_cast<std::size_t>(second) * compared_.size() + axis];
  }

  std::vector<char> compared_;
  int per_second_, window_s_;
  std::vector<Sum> seconds_;  ///< ring of window_s x axes
  int newest_ = 0, full_ = 0, instants_ = 0;
  GapWindow gap_;
};

}  // namespace framewatch::estimator
