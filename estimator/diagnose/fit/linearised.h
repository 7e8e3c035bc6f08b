#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// The whitened equations of all segments around one model.
struct Linearised {
  const Plant* plant = nullptr;
  std::vector<Unknown> unknowns;
  std::vector<Whitened> systems;  ///< of each segment
  std::vector<Columns> columns;   ///< of each segment: d(rows)/d(unknowns)
  /// Ratio of misfit to its expectation under noise, at least 1. The prior is weighted with it, so
  /// that a model that does not fit cannot use masses, gains and clocks to make up for it.
  double level = 1;
  Eigen::VectorXd prior, pull;  ///< level / (2 sigma^2); the same times (centre - value)
};

/// Gram matrix of the unknowns `kept`, the residual and the end terms, in this order.
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

/// square: as square_of() gives it; ends: how many end terms.
NormalEquations without_ends(const Eigen::MatrixXd& square, Eigen::Index ends);
/// Of all segments together.
NormalEquations normal_equations(const Linearised& at);

}  // namespace framewatch::estimator
