#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/linearised.h"

namespace framewatch::estimator {

/// Gram matrix of the unknowns `kept`, the residual and the end terms, in this order. Of a large
/// building the end terms are projected out of the residual and there are none here; the unknowns'
/// own products are those of sampled_bins().
Eigen::MatrixXd square_of(const Linearised& at, std::size_t record,
                          const std::vector<Eigen::Index>& kept);

/// Normal equations of the unknowns with the end terms eliminated; the prior is not included.
struct NormalEquations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;  ///< columns' * rest
  double misfit = 0;         ///< rest' * rest

  NormalEquations& operator+=(const NormalEquations& other);
};

/// Solves normal * step = right within the unknowns' bounds: unknowns that would leave them stop
/// there, and the others are solved again. Not finite when there is no solution.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right,
                             const Model& model, const std::vector<Unknown>& unknowns);

/// How many end terms square_of() gives.
Eigen::Index ends_of(const Linearised& at, std::size_t record);
/// square: as square_of() gives it; ends: how many end terms.
NormalEquations without_ends(const Eigen::MatrixXd& square, Eigen::Index ends);
/// Of all segments together.
NormalEquations normal_equations(const Linearised& at, const Parallel& within = {});

}  // namespace framewatch::estimator
