#pragma once

#include <vector>

#include "estimator/motion/noise_meter.h"
#include "estimator/structure/sensors.h"

namespace framewatch {

/// The noise to reckon with, per axis: as configured, or as measured where it is not.
class ChannelNoise {
 public:
  ChannelNoise(const std::vector<SensorAxis>& axes, double rate_hz);

  void push(const std::vector<double>& accel) {
    if (!configured_) meter_.push(accel);
  }
  /// Of every axis.
  bool configured() const { return configured_; }
  /// m/s^2/sqrt(Hz) of every axis, into a vector of their number; false, and nothing written, while
  /// one is not known.
  bool densities(std::vector<double>& out) const;
  /// Whether an axis without configured noise has changed against the others since `used` by more
  /// than rows should be weighted wrongly by.
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

}  // namespace framewatch
