// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// A model fitted with arbitrary signals at some places, and its remaining misfit.
struct Localisation {
  std::vector<CandidatePlace> candidate_places;
  double misfit = 1e300;  ///< of all segments, with the prior
  double ratio = 1e300;   ///< misfit over its expectation; 1: the rest of the building fits
  std::vector<double> record_ratio;  ///< ratio of each segment
  bool converged = false;            ///< further steps would change nothing
  Model model;
  std::vector<Eigen::MatrixXcd> motion;
};

/// Takes one step of the fit from `at` with arbitrary signals at the places of each list. Needs no
/// law: whatever acts at a place, the rest of the building stays linear.
std::vector<Localisation> localise_once(const Fitter& fitter, const Linearised& at,
                                        const Model& model,
                                        const std::vector<std::vector<CandidatePlace>>& lists,
                                        const Parallel& parallel = {});

/// Fits with arbitrary signals at the places of one list. Iterates until it converges, at most
/// `steps` times.
Localisation localise(const Fitter& fitter, const Model& start,
                      const std::vector<Eigen::MatrixXcd>& motion,
                      const std::vector<CandidatePlace>& candidate_places, int steps);

/// Localizes one element, starting from the fit `now`. Returns nullopt if `element` is not an
/// element of the plant.
std::optional<Localisation> localise_element(const Fitter& fitter, const FitResult& now,
                                             const EffectPlace& element);

}  // namespace framewatch::estimator
