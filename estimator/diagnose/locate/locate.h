// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"

namespace framewatch::estimator {

/// Returns the increase of Localisation::ratio above 1 that is more than chance.
double chance_of(const Fitter& fitter, const Model& model);

/// Places where arbitrary signals would make a model fit.
struct Located {
  std::vector<Localisation> places;  ///< the most likely ones, iterated, best first
  std::vector<Localisation> once;    ///< all places after one step, best first
};

/// Tries every place of the plant.
Located locate(const Fitter& fitter, const FitResult& now, const Parallel& parallel);

/// Returns further places, other than elements, that are as good as the best within chance, best
/// first. Their effects are quick to fit.
std::vector<Localisation> as_likely(const Fitter& fitter, const FitResult& now,
                                    const Located& located, const Parallel& parallel);

/// Returns pairs of places, best first: the best single places with every other, and every two
/// axes.
std::vector<Localisation> locate_pairs(const Fitter& fitter, const FitResult& now,
                                       const std::vector<Localisation>& once,
                                       const Parallel& parallel);

/// Returns pairs of each place with `known`, best first. Finds effects beside a law whose force the
/// noisy measured motion does not determine well enough.
std::vector<Localisation> locate_beside(const Fitter& fitter, const FitResult& now,
                                        const std::vector<Localisation>& once,
                                        const CandidatePlace& known, const Parallel& parallel);

/// Returns the places whose laws are fitted: those near the best, a few of each kind.
std::vector<Localisation> contenders(const SearchSettings& settings,
                                     const std::vector<Localisation>& places);

/// Estimates the corner frequency of the noise (RecordSegment::corner_hz) from the residual with
/// arbitrary signals at a place. Uses most of the cells; in the others some effect is still
/// missing. Sets it in `segments`, which are those of the fitter. Returns true if it changed.
bool set_noise_corner_at(const Fitter& fitter, std::vector<RecordSegment>& segments,
                         const Localisation& place);

}  // namespace framewatch::estimator
