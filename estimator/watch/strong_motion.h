#pragma once

#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// When the building was last shaken strongly, from the channels of its base (all horizontal ones,
/// where the base has none): those are further than a trigger from their mean. Strong motions with
/// less than kCalm_s between them are one.
class StrongMotion {
 public:
  static constexpr double kTrigger_mps2 = 0.1, kCalm_s = 20;

  StrongMotion(const std::vector<SensorAxis>& axes, double rate_hz);

  /// One calibrated instant.
  void push(const SampleSet& set);
  bool any() const { return any_; }
  /// The last strong instant so far, and the largest distance from the mean since the motion began,
  /// m/s^2. Only if any().
  Time last() const { return last_; }
  double peak_mps2() const { return peak_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(any_, last_);
    a.finite(peak_, mean_, seen_);
  }

 private:
  std::vector<std::size_t> axes_;
  double mean_step_;  ///< of the mean's filter, per instant
  bool any_ = false;
  Time last_{};
  double peak_ = 0;
  std::vector<double> mean_, seen_;
};

}  // namespace framewatch::estimator
