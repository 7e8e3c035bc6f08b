#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// A place where an arbitrary signal, free at every frequency, is admitted: the force of an
/// element, forces at nodes, the reading of an axis.
struct CandidatePlace {
  enum class Kind { element, floor, node, link, crossing, rocking, axis } kind = Kind::element;
  EffectPlace place;  ///< as an effect there would give it
  int axis = -1;
  int element = -1;
  /// equations x directions of the forces; empty for axes.
  Eigen::MatrixXd directions;

  Eigen::Index size() const { return kind == Kind::axis ? 1 : directions.cols(); }
};

/// Every place of a plant. Two places whose forces have the same direction appear once. Where axes
/// do not read every motion: axes, what they read of the floors, and stories between two floors
/// that they read, by frame.
std::vector<CandidatePlace> candidate_places_of(const Plant& plant, const Model& model);

/// Recomputes directions that depend on the model's stiffnesses.
void update_directions(const Plant& plant, const Model& model,
                       std::vector<CandidatePlace>& candidate_places);

/// The whitened directions of the places in one bin, orthonormal: equations x directions.
Eigen::MatrixXcd candidate_basis(const Whitened& system, Eigen::Index bin,
                                 const std::vector<CandidatePlace>& candidate_places);

}  // namespace framewatch::estimator
