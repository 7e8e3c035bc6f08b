#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// A model fitted with arbitrary signals at some places: the misfit that is left.
struct Localisation {
  std::vector<CandidatePlace> candidate_places;
  double misfit = 1e300;  ///< of all segments, with the prior
  double ratio = 1e300;   ///< misfit over its expectation; 1: the rest of the building fits
  std::vector<double> record_ratio;  ///< the same of each segment
  bool converged = false;            ///< further steps would change nothing
  Model model;
  std::vector<Eigen::MatrixXcd> motion;
};

/// One step of the fit from `at` with arbitrary signals at the places of each list. Needs no law:
/// whatever acts at one place, the rest of the building stays linear.
std::vector<Localisation> localise_once(const Fitter& fitter, const Linearised& at,
                                        const Model& model,
                                        const std::vector<std::vector<CandidatePlace>>& lists,
                                        const Parallel& parallel = {});

/// The same for one list of places, iterated until it converges, at most `steps` times.
Localisation localise(const Fitter& fitter, const Model& start,
                      const std::vector<Eigen::MatrixXcd>& motion,
                      const std::vector<CandidatePlace>& candidate_places, int steps);

/// The same of one element, beside a fit; empty where the place is none.
std::optional<Localisation> localise_element(const Fitter& fitter, const FitResult& now,
                                             const EffectPlace& element);

}  // namespace framewatch::estimator
