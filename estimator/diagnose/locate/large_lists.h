// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Returns for each list of places in a large building the square of square_of() with the whitened
/// directions of the list's places projected out. The unknowns' products with each other are from
/// sampled_bins().
std::vector<Eigen::MatrixXd> without_sampled(const Eigen::MatrixXd& square, const Linearised& at,
                                             std::size_t record,
                                             const std::vector<Eigen::Index>& kept,
                                             std::span<const std::vector<CandidatePlace>> lists);

/// Returns for each list an upper bound of the misfit with arbitrary signals at its places after
/// one step of the unknowns `kept`. The step uses the curvature without such signals. squares: from
/// square_of(), of each segment.
std::vector<double> rough_misfits(const Linearised& at, const std::vector<Eigen::Index>& kept,
                                  const std::vector<Eigen::MatrixXd>& squares,
                                  const std::vector<std::vector<CandidatePlace>>& lists,
                                  const Parallel& parallel);

}  // namespace framewatch::estimator
