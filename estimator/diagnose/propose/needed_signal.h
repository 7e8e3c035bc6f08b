#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/locate/localise.h"

namespace framewatch::estimator {

/// The force (or reading) of one record that a place must supply for the model to fit: what any law
/// there has to explain.
struct NeededSignal {
  Eigen::VectorXcd force;    ///< N per bin; of an axis: reading, m/s^2
  Eigen::VectorXd weight;    ///< 1 / variance of it
  Eigen::VectorXcd d;        ///< deformation of the element, m, per bin; empty: not an element
  Eigen::VectorXd d_t, v_t;  ///< deformation and its rate in time, Fitter::ratio() steps a sample
  bool has_mass = false;     ///< of a floor: a mass there is linear too
  /// What motion beyond the segment's ends can add to the force (Weights): an orthonormal basis of
  /// real parts, then imaginary parts, times the roots of the weights. Empty: nothing.
  Eigen::MatrixXd ends;

  /// A signal, per bin, without the part that the ends can add.
  Eigen::VectorXcd without_ends(const Eigen::VectorXcd& signal) const;
};

/// The signal that the first place of a localisation needs in every record.
std::vector<NeededSignal> needed_signals(const Fitter& fitter, const Localisation& place);

/// Gives what a floor (a node in one direction, or two) needs the deformation of a contact there:
/// over the ground, or over the lower floor.
void set_motion_of_floor(const Fitter& fitter, const Localisation& place,
                         std::vector<NeededSignal>& needed);

/// The band of a fit, that of its first record.
Band fit_band(const Fitter& fitter);

/// Forces of a linear spring and a linear dashpot of unit size under the needed deformation, and
/// with has_mass of a mass.
/// w: rad/s of the bins.
std::vector<Eigen::VectorXcd> linear_columns(const NeededSignal& needed, const Eigen::VectorXd& w);

/// linear_columns() of one record, then the force of an element law under the needed deformation.
std::vector<Eigen::VectorXcd> columns_with(const ModelEffect& effect, const Fitter& fitter,
                                           const std::vector<NeededSignal>& needed,
                                           std::size_t record);

}  // namespace framewatch::estimator
