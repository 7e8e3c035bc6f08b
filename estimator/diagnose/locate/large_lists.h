#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/linearised.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Of a large building, for each list: the square of square_of() with the whitened directions of
/// the list's places projected out; the products of the unknowns with each other are those of
/// sampled_bins().
std::vector<Eigen::MatrixXd> without_sampled(const Eigen::MatrixXd& square, const Linearised& at,
                                             std::size_t record,
                                             const std::vector<Eigen::Index>& kept,
                                             std::span<const std::vector<CandidatePlace>> lists);

/// Of each list, the misfit that arbitrary signals at its places and one step of the unknowns
/// `kept` leave, the curvature of the step being that without such signals: never less than what is
/// left. squares: of square_of(), of each segment.
std::vector<double> rough_misfits(const Linearised& at, const std::vector<Eigen::Index>& kept,
                                  const std::vector<Eigen::MatrixXd>& squares,
                                  const std::vector<std::vector<CandidatePlace>>& lists,
                                  const Parallel& parallel);

}  // namespace framewatch::estimator
