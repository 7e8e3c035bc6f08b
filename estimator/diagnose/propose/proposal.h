#pragma once

#include "estimator/diagnose/model/model.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// An effect that could act at a place, with start values from the force (or reading) that the
/// place needs.
struct Proposal {
  Model model;      ///< with the effect as its last one, or with an axis' gain or delay freed
  EffectKind kind;  ///< first guess of the name; name_of_fit() decides after the fit
  EffectPlace place;
  double misfit = 0;  ///< of the scalar fit; ranks the proposals of one place
};

}  // namespace framewatch::estimator
