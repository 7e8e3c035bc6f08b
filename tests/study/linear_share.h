#pragma once

#include <Eigen/Core>

#include "tests/study/hidden.h"

namespace framewatch::study {

struct StudyCase;

/// What the stiffness and damping of a linear building can explain of a train record, to first
/// order: the response's derivatives by every parameter. This sizes effects; nothing of it is
/// diagnose's.
class LinearShare {
 public:
  explicit LinearShare(const StudyCase& c);

  const Peaks& peaks() const { return peaks_; }
  /// What they cannot, as a share of the record: of all channels above the base, or of the worst.
  double unexplained(const Eigen::MatrixXd& accel, bool worst_channel) const;

 private:
  Eigen::MatrixXd linear_;       ///< instants x axes
  Eigen::MatrixXd derivatives_;  ///< (instants x axes above the base) x parameters
  Eigen::MatrixXd gram_;
  int base_axes_ = 0;
  Peaks peaks_;
};

}  // namespace framewatch::study
