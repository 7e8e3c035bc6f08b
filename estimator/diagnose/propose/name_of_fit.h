// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/diagnose/fit/search_settings.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// Returns the catalog's name for a fitted effect. Within a family of laws the fitted exponent,
/// duration or width decides. segment: the first one, whose length distinguishes a drop from a
/// drift.
EffectKind name_of_fit(const SearchSettings& settings, const ModelEffect& effect,
                       const RecordSegment& segment);

/// Returns a hysteresis that acts everywhere as the pinched law (LawForm::pinched) acts at zero
/// force. Equivalent to a slip zone as wide as the whole loop.
ModelEffect without_slip(const ModelEffect& pinched);

/// Returns the saturating spring (LawForm::saturating) with the two slopes of a contact.
ModelEffect two_slopes(const ModelEffect& contact);

/// Returns the exponent of the power law that, with a linear spring, is nearest to a spring's force
/// over the deformations of a sine. effect: an element law without memory.
double nearest_exponent(const ModelEffect& effect);

}  // namespace framewatch::estimator
