#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/linearised.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/locate/candidate_places.h"

namespace framewatch::estimator {

/// One step of the fit beside arbitrary signals, with the curvature of all bins.
struct CloserLook {
  Eigen::VectorXd step;  ///< of the unknowns `kept`
  double left = 0;       ///< misfit after it, as the linearised equations have it
};

/// Of a large building, for each list of places: the step by conjugate gradients, with the list's
/// own normal equations from sampled bins (without_sampled) to start and to direct it.
/// equations: of each list, of all segments, their gradients and misfits those of all bins.
std::vector<CloserLook> closer_looks(const Linearised& at, const std::vector<Eigen::Index>& kept,
                                     const std::vector<std::vector<CandidatePlace>>& lists,
                                     const std::vector<NormalEquations>& equations);

}  // namespace framewatch::estimator
