#pragma once

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// The catalogue's name for a fitted effect: within a family of laws the fitted exponent, duration
/// or width decides. segment: the first one, whose length decides between a drop and a drift.
EffectKind name_of_fit(const ModelEffect& effect, const RecordSegment& segment);

/// Hysteresis as a pinched law (LawForm::pinched) has it at zero force, throughout: what a slip
/// zone as wide as the whole loop is.
ModelEffect without_slip(const ModelEffect& pinched);

/// Exponent of the power law that, beside a linear spring, comes nearest to a spring's force over
/// the deformations of a sine. effect: an element law without memory.
double nearest_exponent(const ModelEffect& effect);

}  // namespace framewatch::estimator
