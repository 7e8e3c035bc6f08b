// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// The force (or reading) of one record that a place must supply for the model to fit. Any law at
/// the place has to explain it.
struct NeededSignal {
  Eigen::VectorXcd force;    ///< N per bin; for an axis: reading, m/s^2
  Eigen::VectorXd weight;    ///< 1 / variance of the force
  Eigen::VectorXcd d;        ///< deformation of the element, m, per bin; empty: not an element
  Eigen::VectorXd d_t, v_t;  ///< deformation and its rate in time, Fitter::ratio() steps per sample
  bool has_mass = false;     ///< of a floor: a mass there is linear too
  /// Part of the force that motion beyond the segment's ends can add (Weights): an orthonormal
  /// basis of real parts, then imaginary parts, times the roots of the weights. May be empty.
  Eigen::MatrixXd ends;

  /// Returns a signal, per bin, with the part removed that the ends can add.
  Eigen::VectorXcd without_ends(const Eigen::VectorXcd& signal) const;
};

/// Returns the signal that the first place of a localization needs in every record.
std::vector<NeededSignal> needed_signals(const Fitter& fitter, const Localisation& place);

/// Sets the deformation of a contact at a floor (a node in one direction, or two): relative to the
/// ground, or to the lower floor.
void set_motion_of_floor(const Fitter& fitter, const Localisation& place,
                         std::vector<NeededSignal>& needed);

/// Returns the band of a fit, that of its first record.
Band fit_band(const Fitter& fitter);

/// Returns the forces of a linear spring and a linear dashpot of unit size under the needed
/// deformation; with has_mass also of a mass. w: rad/s of the bins.
std::vector<Eigen::VectorXcd> linear_columns(const NeededSignal& needed, const Eigen::VectorXd& w);

/// Returns linear_columns() of one record, then the force of an element law under the needed
/// deformation.
std::vector<Eigen::VectorXcd> columns_with(const ModelEffect& effect, const Fitter& fitter,
                                           const std::vector<NeededSignal>& needed,
                                           std::size_t record);

/// Weighted least squares of a needed force on complex columns with real coefficients. The last
/// column is the law's.
struct ScalarFit {
  double misfit = 1e300;
  Eigen::VectorXd coefficients;
};

/// Normal equations of one record. Those of several records add up.
struct ScalarSums {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
  double total = 0;  ///< misfit without any column

  ScalarSums& operator+=(const ScalarSums& more);
  ScalarFit fit() const;
};

/// Computes the normal equations of one record. Removes from the force and the columns what the
/// ends of the segment can add.
ScalarSums scalar_sums(const NeededSignal& needed, const std::vector<Eigen::VectorXcd>& columns);

/// Fits the same coefficients to all records. columns: of each record.
ScalarFit scalar_fit(const std::vector<NeededSignal>& needed,
                     const std::vector<std::vector<Eigen::VectorXcd>>& columns);

/// Returns the needed force minus the part that a linear element explains; the whole force if the
/// place is not an element.
Eigen::VectorXcd beyond_linear(const RecordSegment& segment, const NeededSignal& needed);

/// An effect that could act at a place, with start values from the force (or reading) that the
/// place needs.
struct Proposal {
  Model model;      ///< the effect is its last one, or an axis' gain or delay is freed
  EffectKind kind;  ///< first guess of the name; name_of_fit() decides after the fit
  EffectPlace place;
  double misfit = 0;  ///< of the scalar fit; ranks the proposals of one place
};

/// Returns a proposal that adds an effect to a localization's model. misfit: of the scalar fit.
Proposal proposal_of(const Localisation& place, ModelEffect effect, EffectKind kind,
                     double misfit = 0);

}  // namespace framewatch::estimator
