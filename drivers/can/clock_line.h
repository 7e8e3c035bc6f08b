#pragma once

#include <cstddef>
#include <vector>

#include "drivers/can/archive_list.h"

namespace framewatch::drivers {

/// The line that maps a device's time to the host's: host = a + b * device, both microseconds.
/// A frame is never stamped before it was sent, so the line is the one that touches the stamps from
/// below: an edge of their lower convex hull over the last 2048 stamps. Means would shift times by
/// the mean delay of a busy bus. |b - 1| <= 500 ppm.
class ClockLine {
 public:
  /// Forgets every stamp, keeps the rate, and goes through this point.
  void start(double device_us, double host_us);
  void add(double device_us, double host_us);
  bool started() const { return started_; }

  double host_us(double device_us) const;
  /// Host's microseconds per device's.
  double rate() const { return 1 + slope_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_, device0_us_, host0_us_, offset_, slope_, current_, in_bucket_);
    archive_list(a, lowest_);
  }

 private:
  static constexpr int kBucket = 32;           ///< stamps, of which the lowest is kept
  static constexpr std::size_t kBuckets = 64;  ///< kept
  static constexpr std::size_t kForRate = 8;   ///< buckets before the rate is estimated
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
  std::vector<Point> lowest_;  ///< of the closed buckets, oldest first
  Point current_{};
  int in_bucket_ = 0;
};

}  // namespace framewatch::drivers
