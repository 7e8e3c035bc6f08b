#pragma once

#include <memory>

#include <Eigen/Core>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

/// Solves with a symmetric matrix that is positive definite but for rounding: by L L' where there
/// are hundreds of unknowns, then several times as fast as Ldlt; by that one where there are fewer
/// or a pivot is not positive.
class PositiveSolver {
 public:
  PositiveSolver() = default;
  explicit PositiveSolver(const Eigen::MatrixXd& symmetric);

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  std::shared_ptr<const Cholesky> quick_;
  Ldlt thorough_;
};

}  // namespace framewatch::estimator
