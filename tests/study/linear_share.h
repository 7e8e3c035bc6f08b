// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "tests/study/study_case.h"

namespace framewatch::study {

/// The part of a train record that stiffness and damping of a linear building can explain, with
/// masses within their tolerance. Gauss-Newton with the response's derivatives by every parameter
/// and mass of the true building. Sizes effects; shares no code with diagnose.
class LinearShare {
 public:
  explicit LinearShare(const StudyCase& c);

  const Peaks& peaks() const { return peaks_; }
  /// Returns the NRMSE of sensor noise with this ratio to each channel's rms, including the base's
  /// noise passed on by the building.
  double noise_floor(double ratio) const;
  /// Returns the unexplained share of the record: of all channels above the base, or of the worst
  /// one. Stops after the first step if that is below `enough`. Fast, and too large for large
  /// steps, because derivatives stay those of the true building.
  double unexplained(const Eigen::MatrixXd& accel, bool worst_channel, double enough) const;
  /// Returns the unexplained share with new derivatives in every step, at convergence.
  double unexplained_at_the_end(const Eigen::MatrixXd& accel, bool worst_channel) const;

 private:
  /// Parameters, then node masses; changes are relative to their values.
  Eigen::Index unknowns() const {
    return case_.building.theta.size() +
           static_cast<Eigen::Index>(case_.building.truth.node_mass.size());
  }
  double& value(StudyCase& c, Eigen::Index unknown) const;
  /// Returns the response above the base of a linear building, stacked by axes, and its
  /// derivatives.
  Eigen::VectorXd response(const StudyCase& c) const;
  Eigen::MatrixXd derivatives_at(const StudyCase& c, const Eigen::VectorXd& response) const;
  /// Sets the weights of the masses' distance from the declared ones.
  void hold_masses();
  /// A wrong base channel is a wrong input, so it counts by its effect on the channels above.
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
