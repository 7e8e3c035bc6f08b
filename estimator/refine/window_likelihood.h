#pragma once

#include <Eigen/Core>

#include "estimator/refine/measured_building.h"
#include "estimator/refine/segment_likelihood.h"

namespace framewatch::estimator {

/// That of a building with a sensor on every frame of every floor; docs/equations.md (31).
class WindowLikelihood : public SegmentLikelihood {
 public:
  /// Both must outlive this.
  WindowLikelihood(const MeasuredBuilding& building, const Spectrum& spectrum, EndTerms terms);

 private:
  bool operate(const Eigen::VectorXd& theta) override;
  void gather(Eigen::Index b, const Eigen::VectorXcd& force, const Eigen::VectorXcd& motion,
              bool exact_motion, LikelihoodPoint& point, Eigen::MatrixXd& cross) const override;

  const MeasuredBuilding& building_;
};

}  // namespace framewatch::estimator
