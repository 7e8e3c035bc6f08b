#pragma once

#include <vector>

#include "estimator/motion/noise_meter.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// The noise density assumed of every axis: as configured, else as measured.
class AxisNoise {
 public:
  AxisNoise(const std::vector<SensorAxis>& axes, double rate_hz);

  void push(const std::vector<double>& accel) {
    if (!configured_) meter_.push(accel);
  }
  void reset() { meter_.reset(); }
  /// Of every axis.
  bool configured() const { return configured_; }
  /// m/s^2/sqrt(Hz) of every axis, into a vector of their number; false, and nothing written, while
  /// one is not known.
  bool densities(std::vector<double>& out) const;
  /// Whether the ratios of the axes without configured noise have changed since `used` so much that
  /// the rows should be weighted anew.
  bool differs(const std::vector<double>& now, const std::vector<double>& used) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(meter_);
  }

 private:
  std::vector<double> given_;  ///< 0 = not configured
  bool configured_;
  NoiseMeter meter_;
};

}  // namespace framewatch::estimator
