#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/locate/candidate_places.h"

namespace framewatch::estimator {

/// What places that may do anything at all take of the columns' products with the residual, in one
/// bin after another. A few places need no metric of the whole building, as BinProducts makes.
class FewProducts {
 public:
  /// Of the unknowns `kept`; their products with the residual, then its square.
  FewProducts(const Linearised& at, std::size_t record, const std::vector<Eigen::Index>& kept);

  void set_bin(Eigen::Index bin);
  /// Adds the part of a list of places.
  void add(const std::vector<CandidatePlace>& places, Eigen::VectorXd& sum) const;

 private:
  /// equations x directions of the places.
  Eigen::MatrixXcd directions_of(const std::vector<CandidatePlace>& places) const;
  /// directions x columns: products under the metric. whitened: the directions.
  Eigen::MatrixXcd with_columns(const Eigen::MatrixXcd& whitened,
                                const Eigen::MatrixXcd& under) const;

  const Linearised& at_;
  const Whitened& system_;
  const Columns& columns_;
  const std::vector<Eigen::Index>& kept_;
  std::vector<BinProducts::Direction> elements_;
  Eigen::Index bin_ = 0;
  Eigen::MatrixXcd operation_;
};

/// Adds real(C^H S^-1 c) to the sum. square: S, products of directions with each other; columns: C,
/// theirs with columns, of which c is the last.
void add_explained(Eigen::MatrixXcd square, const Eigen::MatrixXcd& columns, Eigen::VectorXd& sum);

}  // namespace framewatch::estimator
