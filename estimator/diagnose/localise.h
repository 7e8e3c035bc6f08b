#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit.h"
#include "estimator/diagnose/parallel.h"

namespace framewatch {

/// A place whose signal may be anything, at every frequency: the force of an element, forces at
/// nodes, the reading of an axis.
struct Suspect {
  enum class Kind { element, floor, node, link, crossing, rocking, axis } kind = Kind::element;
  EffectPlace place;  ///< as an effect there would give it
  int axis = -1;
  int element = -1;
  /// equations x directions of the forces; empty for axes.
  Eigen::MatrixXd directions;

  Eigen::Index size() const { return kind == Kind::axis ? 1 : directions.cols(); }
};

/// What is left when places may do anything.
struct Localisation {
  std::vector<Suspect> suspects;
  double misfit = 1e300;  ///< of all stretches, with the prior
  double ratio = 1e300;   ///< over what noise explains; 1: the rest of the building fits
  std::vector<double> record_ratio;
  bool settled = false;  ///< further steps would change nothing
  Model model;
  std::vector<Eigen::MatrixXcd> motion;
};

/// Every place of a plant. Two places that act alike appear once.
std::vector<Suspect> suspects_of(const Plant& plant, const Model& model);

/// Brings directions that depend on stiffnesses up to date.
void follow(const Plant& plant, const Model& model, std::vector<Suspect>& suspects);

/// Estimates what is left if the suspects of each list may do anything, one step of the fit away
/// from `at`; Model-free: whatever law acts in one place leaves the rest of a building linear.
std::vector<Localisation> localise_once(const Fitter& fitter, const Linearised& at,
                                        const Model& model,
                                        const std::vector<std::vector<Suspect>>& lists,
                                        const Parallel& parallel = {});

/// The same, iterated.
Localisation localise(const Fitter& fitter, const Model& start,
                      const std::vector<Eigen::MatrixXcd>& motion,
                      const std::vector<Suspect>& suspects, int steps);

/// The whitened directions of suspects at one bin, orthonormal: equations x directions.
Eigen::MatrixXcd suspect_basis(const Whitened& system, Eigen::Index bin,
                               const std::vector<Suspect>& suspects);

}  // namespace framewatch
