#include "estimator/numeric/positive_solver.h"

#include <utility>

namespace framewatch::estimator {

using Eigen::MatrixXd;
using Eigen::VectorXd;

PositiveSolver::PositiveSolver(const MatrixXd& symmetric) {
  constexpr Eigen::Index kPays = 200;  // unknowns
  if (symmetric.cols() >= kPays)
    if (auto quick = std::make_shared<const Cholesky>(symmetric); quick->good()) {
      quick_ = std::move(quick);
      return;
    }
  thorough_ = Ldlt(symmetric);
}

VectorXd PositiveSolver::solve(const VectorXd& right) const {
  return quick_ ? VectorXd(quick_->solve(MatrixXd(right))) : thorough_.solve(right);
}

}  // namespace framewatch::estimator
