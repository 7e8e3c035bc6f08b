#pragma once

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// The catalogue's name for a fitted effect: within a family of laws the fitted exponent, duration
/// or width decides. segment: the first one, whose length decides between a drop and a drift.
EffectKind name_of_fit(const ModelEffect& effect, const RecordSegment& segment);

}  // namespace framewatch::estimator
