#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/row_matrix.h"

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

}  // namespace framewatch::estimator
