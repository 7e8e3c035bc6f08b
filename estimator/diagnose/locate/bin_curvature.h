#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

/// The curvature of the misfit by the unknowns `kept` beside arbitrary signals at the places of
/// each of several lists, times a step for each list; bin by bin, no curvature is ever formed.
class BinCurvature {
 public:
  /// What is given has to stay.
  BinCurvature(const Linearised& at, std::size_t record, const std::vector<Eigen::Index>& kept,
               const std::vector<std::vector<CandidatePlace>>& lists);

  /// sum += curvature of the bin times steps; both unknowns x lists.
  void add_times(Eigen::Index bin, const RowMatrix& steps, RowMatrix& sum);

 private:
  using Direction = BinProducts::Direction;
  struct Complexes {
    RowMatrix real, imaginary;
  };

  /// The forces of the steps on the equations: equations x lists.
  void put_forces(Eigen::Index bin, const RowMatrix& steps);
  /// They under the metric, without what the lists' places may make of them.
  void put_under_metric();
  /// The products of these with every direction.
  void put_along();
  /// The forces that a column without a direction stands for in a bin.
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
