// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "drivers/can/archive_containers.h"

namespace framewatch::drivers {

/// Models a device's clock: host = a + b * device in microseconds, |b - 1| <= 500 ppm. A frame is
/// never stamped before it was sent, so the model is the lower envelope of the receive stamps: an
/// edge of the lower convex hull of the last 2048. A mean would shift times by the mean delay of a
/// busy bus.
class LowerEnvelopeClock {
 public:
  /// Drops all stamps and keeps the rate; the model then goes through this point.
  void start(double device_us, double host_us);
  /// Adds the receive stamp `host_us` of a frame sent at `device_us`.
  void add(double device_us, double host_us);
  bool started() const { return started_; }

  /// Returns the host time at a device time.
  double host_us(double device_us) const;
  /// Returns host microseconds per device microsecond.
  double rate() const { return 1 + slope_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_, device0_us_, host0_us_, offset_, slope_, current_, in_bucket_);
    archive_vector(a, lowest_);
  }

 private:
  static constexpr int kBucket = 32;           ///< stamps of which the lowest is kept
  static constexpr std::size_t kBuckets = 64;  ///< buckets kept
  static constexpr std::size_t kForRate = 8;   ///< buckets needed for the rate
  static constexpr double kMaxSlope = 500e-6;

  struct Point {
    double x = 0, e = 0;  ///< device time since origin; host minus device since origin

    template <typename Archive>
    void archive(Archive& a) {
      a(x, e);
    }
  };
  double above(const Point& p) const { return p.e - offset_ - slope_ * p.x; }
  void fit();

  bool started_ = false;
  double device0_us_ = 0, host0_us_ = 0;
  double offset_ = 0, slope_ = 0;
  std::vector<Point> lowest_;  ///< one for each full bucket, oldest first
  Point current_{};
  int in_bucket_ = 0;
};

/// Follows a clock model without jumps, so that equal steps stay nearly equal when the offset of
/// the model is corrected. Times run at most 0.2 % faster or slower than the model.
class SlewLimiter {
 public:
  /// Takes the next time from the model unchanged.
  void reset() { started_ = false; }

  /// Returns the host time to use for `device_us`, where the model says `model_us` and runs at
  /// `rate`. All in microseconds.
  double follow(double device_us, double model_us, double rate) {
    const double step_us = device_us - device_us_;
    const double free_us = kSlew * std::max(0.0, step_us);
    const double on_us = host_us_ + step_us * rate;
    const double time_us =
        started_ ? on_us + std::clamp(model_us - on_us, -free_us, free_us) : model_us;
    if (!started_ || step_us > 0) {
      started_ = true;
      device_us_ = device_us;
      host_us_ = time_us;
    }
    return time_us;
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_, device_us_, host_us_);
  }

 private:
  static constexpr double kSlew = 0.002;

  bool started_ = false;
  double device_us_ = 0, host_us_ = 0;  ///< newest time returned
};

}  // namespace framewatch::drivers
