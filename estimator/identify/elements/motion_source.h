#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion/drift_controlled_integrator.h"

namespace framewatch::estimator {

/// Motion of the whole building at one instant as the regressor rows need it.
struct DeformationSet {
  std::vector<double> values;       ///< as the MotionSource says
  std::vector<std::uint8_t> known;  ///< flags of what is measured, likewise

  template <typename Archive>
  void archive(Archive& a) {
    a.finite(values);
    a.each_within(known, 0, 1);
  }
};

/// Turns filtered axis motion into what rows are formed of.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  virtual void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const = 0;
  virtual DeformationSet make_set() const = 0;
};

}  // namespace framewatch::estimator
