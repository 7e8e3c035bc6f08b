#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/linearised.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/positive_solver.h"

namespace framewatch::estimator {

/// One step of the fit beside arbitrary signals, with the curvature of all bins.
struct CloserLook {
  Eigen::VectorXd step;  ///< of the unknowns `kept`
  double left = 0;       ///< misfit after it, as the linearised equations have it
};

/// What a list's places leave: the unknowns' products with the residual, and its own
/// (last_without).
struct LeftByPlaces {
  Eigen::VectorXd gradient;
  double misfit = 0;
};

/// Of a large building, for each list of places: the step by conjugate gradients, directed by the
/// curvature without places. left: of each list, of all segments.
std::vector<CloserLook> closer_looks(const Linearised& at, const std::vector<Eigen::Index>& kept,
                                     const std::vector<std::vector<CandidatePlace>>& lists,
                                     const std::vector<LeftByPlaces>& left,
                                     const PositiveSolver& curvature);

}  // namespace framewatch::estimator
