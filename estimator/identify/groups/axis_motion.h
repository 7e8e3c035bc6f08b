#pragma once

#include "estimator/identify/elements/motion_source.h"

namespace framewatch::estimator {

/// The filtered motion of every axis as it is: kSignals values per axis, one flag each.
class AxisMotion : public MotionSource {
 public:
  /// p, p', p'', and p', p'' for the inputs of a simulation (held_triple).
  static constexpr int kSignals = 5;
  enum Signal { value, first, second, held_first, held_second };

  explicit AxisMotion(int axes) : axes_(axes) {}
  void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const override;
  DeformationSet make_set() const override;

 private:
  int axes_;
};

}  // namespace framewatch::estimator
