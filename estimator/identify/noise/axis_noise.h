// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/motion/noise_meter.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// The noise density of every axis: the configured one, otherwise the measured one.
class AxisNoise {
 public:
  AxisNoise(const std::vector<SensorAxis>& axes, double rate_hz);

  void push(const std::vector<double>& accel) {
    if (!configured_) meter_.push(accel);
  }
  void reset() { meter_.reset(); }
  /// Returns true if the noise of every axis is configured.
  bool configured() const { return configured_; }
  /// Writes the density of every axis, m/s^2/sqrt(Hz), into `out`, which has one entry per axis.
  /// Returns false and writes nothing while a density is unknown.
  bool densities(std::vector<double>& out) const;
  /// Returns true if the ratios of the axes without configured noise have changed so much since
  /// `used` that the rows should be reweighted.
  bool differs(const std::vector<double>& now, const std::vector<double>& used) const;

  void archive(auto& a) { a(meter_); }

 private:
  std::vector<double> given_;  ///< 0: not configured
  bool configured_;
  NoiseMeter meter_;
};

}  // namespace framewatch::estimator
