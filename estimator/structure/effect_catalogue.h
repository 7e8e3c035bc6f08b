// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// Returns the descriptions of all kinds in the order of EffectKind. In their equations d is an
/// element's deformation b'y (Element::b, m) and v its rate, m/s. Forces are restoring forces added
/// to k d + c v, N.
std::span<const EffectDescription> effect_catalogue();

}  // namespace framewatch::estimator
