#pragma once

#include <vector>

#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// The force of the effect unmeasured_force, N, positive toward +x or +y: a sine and a stationary
/// Gaussian one made of many sines of seeded frequencies and phases. The same on every machine.
class AppliedForce {
 public:
  explicit AppliedForce(const Effect& effect);

  double from_s() const { return from_s_; }
  /// N at time_s, as if it had acted for ever.
  double at(double time_s) const;

 private:
  struct Tone {
    double amplitude;  ///< N
    double omega;      ///< rad/s
    double phase;      ///< rad
  };
  std::vector<Tone> tones_;
  double from_s_;
};

}  // namespace framewatch::estimator
