#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/linearised.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/locate/candidate_places.h"

namespace framewatch::estimator {

/// One step of a fit with arbitrary signals, using the curvature of all bins.
struct CloserLook {
  Eigen::VectorXd step;  ///< of the unknowns `kept`
  double left = 0;       ///< misfit after the step, by the linearised equations
};

/// Computes for each list of places in a large building one step by conjugate gradients. The list's
/// normal equations from sampled bins (without_sampled) are the start and the preconditioner.
/// equations: of each list, summed over segments; their gradients and misfits include all bins.
std::vector<CloserLook> closer_looks(const Linearised& at, const std::vector<Eigen::Index>& kept,
                                     const std::vector<std::vector<CandidatePlace>>& lists,
                                     const std::vector<NormalEquations>& equations);

}  // namespace framewatch::estimator
