#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// What sort of force acts at a place, whatever its law.
enum class LawKind {
  linear,        ///< nothing beyond a spring and a dashpot
  elastic,       ///< of the deformation: what was stored comes back
  impact,        ///< of the deformation, from a clearance on, and of the rate there
  dissipative,   ///< of the rate
  hysteretic,    ///< of the deformation and its past
  time_varying,  ///< a stiffness that changes with time
  external,      ///< of none of these: it does not follow the motion
};

const char* law_kind_word(LawKind kind);

/// Whether a force of a kind is a function of the motion and its past.
bool follows_motion(LawKind kind);

/// Whether a law of the catalogue is of a kind. Friction is of two: it acts against the rate, and
/// remembers where it stuck. So is amplitude dependence, which may be slip.
bool is_of_kind(EffectKind law, LawKind kind);
bool is_of_deformation(EffectKind law);  ///< alone: elastic, or an impact
inline bool changes_with_time(EffectKind law) {
  return is_of_kind(law, LawKind::time_varying);
}

/// The force that a place needs beyond a linear element, averaged over cells of deformation and
/// rate: a picture of the law.
struct RestoringSurface {
  Eigen::VectorXd d_m, v_mps;  ///< middles of the cells
  Eigen::MatrixXd force_n;     ///< d x v; NaN where the motion hardly was
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

/// The kind by regression of the force on general functions: of deformation (powers, a broken
/// line), of rate (as strong as the deformation says, too), of the past (stop operators of several
/// widths: Prandtl 1928, Masri and Caughey 1979, which may fade with what was before; springs slack
/// up to where they have been), of deformation with a stiffness that varies in time, and springs
/// and dashpots beyond the best clearance, which count as impact where powers do worse. The
/// simplest of those that explain about as much as the best. needed: of an element, or of a
/// floor with its motion (set_motion_of_floor()).
KindOfLaw kind_of_law(const Fitter& fitter, const std::vector<NeededSignal>& needed);

}  // namespace framewatch::estimator
