#pragma once

#include <vector>

#include "estimator/structure/effect.h"
#include "estimator/structure/sensors.h"

namespace framewatch {

/// Takes the effects of channels that a model knows out of what the channels measure, so that it
/// compares with the building's motion. A drifting bias is the high-pass filter's.
class ChannelCorrection {
 public:
  /// axes: with what is left of their delays.
  ChannelCorrection(const std::vector<SensorAxis>& axes, const std::vector<Effect>& effects,
                    double rate_hz);

  /// Instants that all channels are held back, for the latest of them.
  int held_back() const { return longest_; }
  /// Of each axis: what is left of its delay, at most half an instant, in instants.
  const std::vector<double>& rest() const { return rest_; }
  /// accel: one value per axis, NaN where missing; valid until the next call.
  const std::vector<double>& apply(const std::vector<double>& accel);

  template <typename Archive>
  void archive(Archive& a) {
    a(ring_, newest_);
  }

 private:
  std::vector<Effect> effects_;
  std::size_t axes_;
  int longest_ = 0;
  std::vector<int> whole_;  ///< delays, instants
  std::vector<double> rest_;
  std::vector<double> ring_;  ///< instants x axes
  int newest_ = 0, length_ = 1;
  std::vector<double> aligned_;
};

}  // namespace framewatch
