// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// A bin that stands for `weight` bins in the curvature of a fit.
struct SampledBin {
  Eigen::Index bin = 0;
  double weight = 1;
};

/// Returns the bins whose products make up the curvature of a fit to a large building: about a
/// quarter of all (with an eighth, the curvature is far too small along some directions). Bins with
/// much motion are always included; others are sampled with a chance proportional to their share of
/// it (systematic sampling, weighted by the inverse chance). Bins with much of an effect's column
/// are included too. The curvature only directs steps; gradients and misfits use all bins.
std::vector<SampledBin> sampled_bins(const Linearised& at, std::size_t record);

/// Returns the Gram matrix of the unknowns `kept`, the residual and the end terms, in this order.
/// For a large building there are no end terms (they are projected out of the residual), and the
/// unknowns' products are those of sampled_bins().
Eigen::MatrixXd square_of(const Linearised& at, std::size_t record,
                          const std::vector<Eigen::Index>& kept);

/// Normal equations of the unknowns with the end terms eliminated; the prior is not included.
struct NormalEquations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;  ///< columns' * rest
  double misfit = 0;         ///< rest' * rest

  NormalEquations& operator+=(const NormalEquations& other);
};

/// Solves normal * step = right within the unknowns' bounds. Unknowns that would leave their bounds
/// stop there, and the others are solved again. The result is not finite if there is no solution.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right,
                             const Model& model, const std::vector<Unknown>& unknowns);

/// Returns the number of end terms of square_of().
Eigen::Index ends_of(const Linearised& at, std::size_t record);
/// Eliminates the end terms. square: from square_of(); ends: number of end terms.
NormalEquations without_ends(const Eigen::MatrixXd& square, Eigen::Index ends);
/// Returns the sum over all segments.
NormalEquations normal_equations(const Linearised& at, const Parallel& within = {});

}  // namespace framewatch::estimator
