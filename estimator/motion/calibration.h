#pragma once

#include <vector>

#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// From scaled sensor values to absolute acceleration along the frames, m/s^2: offset, polarity,
/// gravity on a tilted axis, and the share of the other horizontal direction on an axis that is
/// turned in plan. docs/equations.md, mounting.
class Calibration {
 public:
  explicit Calibration(const std::vector<SensorAxis>& axes);
  /// In place, one value per axis; an axis without the value it is corrected with becomes NaN.
  void apply(std::vector<double>& accel);

 private:
  struct Axis {
    double gain, offset;  ///< value = gain * (scaled - offset)
    int cross;            ///< -1 none
    double own = 1, other = 0;
  };
  std::vector<Axis> axes_;
  std::vector<double> straight_;
};

}  // namespace framewatch::estimator
