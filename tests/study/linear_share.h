#pragma once

#include <Eigen/Core>

#include "tests/study/study_case.h"

namespace framewatch::study {

/// What the stiffness and damping of a linear building can explain of a train record, and masses as
/// far as their tolerance and the noise let them: Gauss-Newton with the response's derivatives by
/// every parameter and mass of the true building. This sizes effects; nothing of it is diagnose's.
class LinearShare {
 public:
  explicit LinearShare(const StudyCase& c);

  const Peaks& peaks() const { return peaks_; }
  /// NRMSE that sensors' noise of a ratio to each channel's rms makes, that of the base passed on
  /// by the building.
  double noise_floor(double ratio) const;
  /// What they cannot, as a share of the record: of all channels above the base, or of the worst.
  /// Below `enough` the first step's. Quick, and too large where the fit goes far: derivatives stay
  /// those of the true building.
  double unexplained(const Eigen::MatrixXd& accel, bool worst_channel, double enough) const;
  /// The same with derivatives anew in every step, to where the fit ends.
  double unexplained_at_the_end(const Eigen::MatrixXd& accel, bool worst_channel) const;

 private:
  /// Parameters, then node masses; changes are relative to their values.
  Eigen::Index unknowns() const {
    return case_.building.theta.size() +
           static_cast<Eigen::Index>(case_.building.truth.node_mass.size());
  }
  double& value(StudyCase& c, Eigen::Index unknown) const;
  /// Response above the base of a linear building, stacked by axes, and its derivatives.
  Eigen::VectorXd response(const StudyCase& c) const;
  Eigen::MatrixXd derivatives_at(const StudyCase& c, const Eigen::VectorXd& response) const;
  /// Weight of a mass's distance from what is declared.
  void hold_masses();
  /// A wrong base channel is a wrong input: counted as what it would be on the channels above.
  double share_of(const Eigen::VectorXd& rest, const Eigen::MatrixXd& accel,
                  bool worst_channel) const;

  StudyCase case_;               ///< with nothing hidden
  Eigen::MatrixXd linear_;       ///< instants x axes
  Eigen::MatrixXd derivatives_;  ///< (instants x axes above the base) x unknowns, of norm 1
  Eigen::VectorXd norms_;        ///< of the derivatives
  Eigen::VectorXd held_;         ///< for each unknown, in the gram matrix's units; 0 = free
  Eigen::MatrixXd gram_;
  int base_axes_ = 0;
  Peaks peaks_;
  double amplified_ = 0;
};

}  // namespace framewatch::study
