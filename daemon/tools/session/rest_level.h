#pragma once

#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// Measures how far the acceleration of each axis is from its resting level, which follows offset
/// and slow drift with a time constant of 5 s.
class RestLevel {
 public:
  RestLevel(std::size_t axes, double rate_hz);

  /// Distances, m/s^2; NaN for a missing sample and during an axis' first second.
  const std::vector<double>& push(const estimator::SampleSet& set);

 private:
  struct Axis {
    double mean = 0;
    long seen = 0;
  };
  long settled_, memory_;  ///< samples
  std::vector<Axis> axes_;
  std::vector<double> distance_;
};

}  // namespace framewatch::daemon
