#pragma once

#include <vector>

#include "estimator/diagnose/localise.h"

namespace framewatch {

/// An effect that could be what acts at a place, with start values from the force (or reading)
/// that the place needs.
struct Proposal {
  Model model;      ///< with the effect as its last, or an axis freed
  EffectKind kind;  ///< first guess of the name; name_of_fit() after the fit
  EffectPlace place;
  double misfit = 0;  ///< of the scalar fit, to rank proposals of one place
};

/// All laws of the catalogue that can act at the `which`-th place of a localisation, best scalar
/// fit first within elements and nodes.
std::vector<Proposal> propose(const Fitter& fitter, const Localisation& place, std::size_t which);

/// The name that fitted values deserve: exponents, durations and widths decide inside a family.
EffectKind name_of_fit(const ModelEffect& effect, const Stretch& stretch);

}  // namespace framewatch
