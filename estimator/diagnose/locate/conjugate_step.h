// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

/// Curvature of the misfit by the unknowns `kept`, with arbitrary signals at the places of each of
/// several lists. Multiplies it by one step for each list, bin by bin, without forming it.
class BinCurvature {
 public:
  /// The arguments must outlive the object.
  BinCurvature(const Linearised& at, std::size_t record, const std::vector<Eigen::Index>& kept,
               const std::vector<std::vector<CandidatePlace>>& lists);

  /// Adds the curvature of the bin times the steps to `sum`; both are unknowns x lists.
  void add_times(Eigen::Index bin, const RowMatrix& steps, RowMatrix& sum);

 private:
  using Direction = BinProducts::Direction;
  struct Complexes {
    RowMatrix real, imaginary;
  };

  /// Computes the forces of the steps on the equations: equations x lists.
  void put_forces(Eigen::Index bin, const RowMatrix& steps);
  /// Multiplies the forces by the metric and projects out the directions of the lists' places.
  void put_under_metric();
  /// Computes the products of the result with every direction.
  void put_along();
  /// Returns the forces of a column without a direction in a bin.
  Eigen::VectorXcd effect_force(Eigen::Index bin, Eigen::Index unknown) const;

  const Whitened& system_;
  const Columns& columns_;
  const std::vector<Eigen::Index>& kept_;
  const std::vector<std::vector<CandidatePlace>>& lists_;
  BinProducts products_;
  std::vector<Direction> elements_;
  Eigen::Index axes_;
  Complexes along_;   ///< directions (elements, axes, equations) x lists
  Complexes forces_;  ///< equations x lists
  Complexes under_;   ///< equations x lists
};

/// One step of a fit with arbitrary signals, using the curvature of all bins.
struct ConjugateStep {
  Eigen::VectorXd step;  ///< of the unknowns `kept`
  double left = 0;       ///< misfit after the step, by the linearised equations
};

/// Computes for each list of places in a large building one step by conjugate gradients. The list's
/// normal equations from sampled bins (without_sampled) are the start and the preconditioner.
/// equations: of each list, summed over segments; their gradients and misfits include all bins.
std::vector<ConjugateStep> conjugate_steps(const Linearised& at,
                                           const std::vector<Eigen::Index>& kept,
                                           const std::vector<std::vector<CandidatePlace>>& lists,
                                           const std::vector<NormalEquations>& equations);

}  // namespace framewatch::estimator
