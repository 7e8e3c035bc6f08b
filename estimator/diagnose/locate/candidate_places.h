// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// A place where a localization admits an arbitrary signal, free at every frequency: the force of
/// an element, forces at nodes, or the reading of an axis.
struct CandidatePlace {
  enum class Kind { element, floor, node, link, crossing, rocking, axis } kind = Kind::element;
  EffectPlace place;  ///< place of an effect there
  int axis = -1;
  int element = -1;
  /// equations x directions of the forces; empty for axes.
  Eigen::MatrixXd directions;

  Eigen::Index size() const { return kind == Kind::axis ? 1 : directions.cols(); }
};

/// Returns every place of a plant. Of places whose forces have the same direction, only the first
/// is included. If axes do not read every motion: the axes, the motions of floors that they read,
/// and stories of a frame between two floors that they read.
std::vector<CandidatePlace> candidate_places_of(const Plant& plant, const Model& model);

/// Recomputes directions that depend on the model's stiffnesses.
void update_directions(const Plant& plant, const Model& model,
                       std::vector<CandidatePlace>& candidate_places);

/// Returns the whitened directions of the places in one bin, orthonormal: equations x directions.
Eigen::MatrixXcd candidate_basis(const Whitened& system, Eigen::Index bin,
                                 const std::vector<CandidatePlace>& candidate_places);

/// Products of the orthonormal whitened directions of a list of places with the columns, and with
/// unit forces on the equations: directions x columns or equations.
struct PlaceProducts {
  Eigen::MatrixXcd columns, equations;
};

/// Computes both. products: of the bin of its last compute().
PlaceProducts place_products(const BinProducts& products,
                             const std::vector<CandidatePlace>& places);
/// Computes the products with unit forces only, which need only BinProducts::put_metric().
Eigen::MatrixXcd place_equations(const BinProducts& products,
                                 const std::vector<CandidatePlace>& places);

}  // namespace framewatch::estimator
