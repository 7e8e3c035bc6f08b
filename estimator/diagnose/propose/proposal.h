#pragma once

#include "estimator/diagnose/model/model.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// An effect that could act at a place, with start values from the force (or reading) that the
/// place needs.
struct Proposal {
  Model model;      ///< the effect is its last one, or an axis' gain or delay is freed
  EffectKind kind;  ///< first guess of the name; name_of_fit() decides after the fit
  EffectPlace place;
  double misfit = 0;  ///< of the scalar fit; ranks the proposals of one place
};

}  // namespace framewatch::estimator
