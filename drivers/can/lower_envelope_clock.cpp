// SPDX-License-Identifier: MIT
#include "drivers/can/lower_envelope_clock.h"

namespace framewatch::drivers {

void LowerEnvelopeClock::start(double device_us, double host_us) {
  started_ = true;
  device0_us_ = device_us;
  host0_us_ = host_us;
  offset_ = 0;
  lowest_.clear();
  in_bucket_ = 0;
}

double LowerEnvelopeClock::host_us(double device_us) const {
  const double x = device_us - device0_us_;
  return host0_us_ + x + offset_ + slope_ * x;
}

void LowerEnvelopeClock::add(double device_us, double host_us) {
  const double x = device_us - device0_us_;
  const Point p{x, (host_us - host0_us_) - x};
  if (in_bucket_ == 0 || above(p) < above(current_)) current_ = p;
  offset_ += std::min(0.0, above(p));
  if (++in_bucket_ < kBucket) return;
  in_bucket_ = 0;
  if (lowest_.size() == kBuckets) lowest_.erase(lowest_.begin());
  lowest_.push_back(current_);
  fit();
}

void LowerEnvelopeClock::fit() {
  if (lowest_.size() >= kForRate) {
    // Stamps may arrive out of order.
    std::vector<Point> points = lowest_;
    std::sort(points.begin(), points.end(),
              [](const Point& a, const Point& b) { return a.x < b.x; });
    std::vector<Point> hull;
    for (const Point& p : points) {
      while (hull.size() >= 2) {
        const Point &a = hull[hull.size() - 2], &b = hull.back();
        if ((b.e - a.e) * (p.x - a.x) < (p.e - a.e) * (b.x - a.x)) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    const double middle = (points.front().x + points.back().x) / 2;
    for (std::size_t i = 1; i < hull.size(); ++i) {
      if (hull[i].x < middle || hull[i].x <= hull[i - 1].x) continue;
      const double slope = (hull[i].e - hull[i - 1].e) / (hull[i].x - hull[i - 1].x);
      slope_ = std::clamp(slope, -kMaxSlope, kMaxSlope);
      break;
    }
  }
  offset_ = lowest_.front().e - slope_ * lowest_.front().x;
  for (const Point& p : lowest_) offset_ += std::min(0.0, above(p));
}

}  // namespace framewatch::drivers
