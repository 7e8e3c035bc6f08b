// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// Kind of force that acts at a place, independent of its law.
enum class LawKind {
  linear,        ///< nothing beyond a spring and a dashpot
  elastic,       ///< of the deformation: returns the stored energy
  impact,        ///< of the deformation beyond a clearance, and of the rate there
  dissipative,   ///< of the rate
  hysteretic,    ///< of the deformation and its past
  time_varying,  ///< a stiffness that changes with time
  external,      ///< none of these: does not follow the motion
};

const char* law_kind_word(LawKind kind);

/// Returns true if a force of this kind is a function of the motion and its past.
bool follows_motion(LawKind kind);

/// Returns true if a law of the catalog is of this kind. Some laws are of two kinds. Friction acts
/// against the rate and remembers where it stuck; amplitude dependence may be elastic or slip.
bool is_of_kind(EffectKind law, LawKind kind);
bool is_of_deformation(EffectKind law);  ///< alone: elastic, or an impact
inline bool changes_with_time(EffectKind law) {
  return is_of_kind(law, LawKind::time_varying);
}

/// The force that a place needs beyond a linear element, averaged over cells of deformation and
/// rate. It shows the shape of the law.
struct RestoringSurface {
  Eigen::VectorXd d_m, v_mps;  ///< middles of the cells
  Eigen::MatrixXd force_n;     ///< d x v; NaN in cells with hardly any samples
  Eigen::MatrixXi count;       ///< samples of each cell
};

struct KindOfLaw {
  LawKind kind = LawKind::linear;
  /// Share of the force beyond a linear element and noise that a general force of each kind
  /// explains, in the order of LawKind.
  std::array<double, 7> share{};
  RestoringSurface surface;
  /// Loops: deformation and force beyond linear in the strongest record, one value per sample.
  Eigen::VectorXd d_m, force_n;
};

/// Determines the kind of a force by regression on general functions of these kinds.
///
/// - `elastic`: powers of the deformation and a broken line
/// - `dissipative`: functions of the rate, also scaled by the deformation
/// - `hysteretic`: stop operators of several widths (Prandtl 1928, Masri and Caughey 1979), which
///   may fade with past motion, and springs that become slack
/// - `time_varying`: the deformation with a stiffness that varies in time
/// - `impact`: springs and dashpots beyond the best clearance, if powers do worse
///
/// Returns the simplest kind that explains about as much as the best. needed: of an element, or of
/// a floor with its motion (set_motion_of_floor()).
KindOfLaw kind_of_law(const Fitter& fitter, const std::vector<NeededSignal>& needed);

}  // namespace framewatch::estimator
