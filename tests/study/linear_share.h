#pragma once

#include <Eigen/Core>

#include "tests/study/study_case.h"

namespace framewatch::study {

/// What the stiffness and damping of a linear building can explain of a train record: Gauss-Newton
/// with the response's derivatives by every parameter of the true building. This sizes effects;
/// nothing of it is diagnose's.
class LinearShare {
 public:
  explicit LinearShare(const StudyCase& c);

  const Peaks& peaks() const { return peaks_; }
  /// NRMSE that sensors' noise of a ratio to each channel's rms makes, that of the base passed on
  /// by the building.
  double noise_floor(double ratio) const;
  /// What they cannot, as a share of the record: of all channels above the base, or of the worst.
  /// Below `enough` the first step's.
  double unexplained(const Eigen::MatrixXd& accel, bool worst_channel, double enough) const;

 private:
  Eigen::MatrixXd linear_;       ///< instants x axes
  Eigen::MatrixXd derivatives_;  ///< (instants x axes above the base) x parameters
  Eigen::MatrixXd gram_;
  Eigen::VectorXd norms_;  ///< of the derivatives
  int base_axes_ = 0;
  Peaks peaks_;
  StudyCase case_;  ///< with nothing hidden
  double amplified_ = 0;
};

}  // namespace framewatch::study
