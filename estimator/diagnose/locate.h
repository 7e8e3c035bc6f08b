#pragma once

#include <vector>

#include "estimator/diagnose/localise.h"

namespace framewatch {

constexpr double kSignificant = 4;  ///< standard deviations of the misfit under noise

/// Of the ratio of a model's misfit to what noise explains: what is more than chance.
double chance_of(const Fitter& fitter, const Model& model);

/// Where it is that a model does not fit.
struct Located {
  std::vector<Localisation> places;  ///< the most likely ones, fitted again, best first
  std::vector<Localisation> once;    ///< all, after one step, best first
};

/// Every place of the plant.
Located locate(const Fitter& fitter, const FitResult& now, const Parallel& parallel);

/// Further places that do as well as the best within chance, if what can be there is quick to fit:
/// all but elements. Best first.
std::vector<Localisation> as_likely(const Fitter& fitter, const FitResult& now,
                                    const Located& located, const Parallel& parallel);

/// Two places at once: the best single ones with every other, and every two axes. Best first.
std::vector<Localisation> locate_pairs(const Fitter& fitter, const FitResult& now,
                                       const std::vector<Localisation>& once,
                                       const Parallel& parallel);

/// Places that leave least if `known`, too, may do anything: what acts beside a law whose force the
/// measured, noisy motion does not tell well enough. Best first.
std::vector<Localisation> locate_beside(const Fitter& fitter, const FitResult& now,
                                        const std::vector<Localisation>& once, const Suspect& known,
                                        const Parallel& parallel);

/// Those of the places whose laws are worth a fit: near the best, few of a kind.
std::vector<Localisation> contenders(const std::vector<Localisation>& places);

}  // namespace framewatch
