#pragma once

#include <cstddef>
#include <vector>

#include "drivers/can/archive_containers.h"

namespace framewatch::drivers {

/// Linear model of a device's clock: host = a + b * device, both microseconds. A frame is never
/// stamped before it was sent, so the model is the lower envelope of the receive stamps: an edge of
/// the lower convex hull of the last 2048. A mean would shift times by the mean delay of a busy
/// bus. |b - 1| <= 500 ppm.
class LowerEnvelopeClock {
 public:
  /// Forgets every stamp and keeps the rate; the model goes through this point.
  void start(double device_us, double host_us);
  void add(double device_us, double host_us);
  bool started() const { return started_; }

  double host_us(double device_us) const;
  /// Host's microseconds per device's.
  double rate() const { return 1 + slope_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_, device0_us_, host0_us_, offset_, slope_, current_, in_bucket_);
    archive_vector(a, lowest_);
  }

 private:
  static constexpr int kBucket = 32;           ///< stamps, of which the lowest is kept
  static constexpr std::size_t kBuckets = 64;  ///< kept
  static constexpr std::size_t kForRate = 8;   ///< buckets that the rate needs
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
