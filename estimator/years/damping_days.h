// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/years/years_watch.h"

namespace framewatch::estimator {

/// A YearsWatch follows damping as the stiffness that is its power -1/kDampingPower. So a growth of
/// damping counts as a loss, and the priors of stiffness allow weather, slow changes and damage to
/// move damping ten times as much. In long records of buildings damping scatters by 20 to 50 %
/// where stiffness changes by a few percent.
inline constexpr double kDampingPower = 10;

/// Returns a day's damping as that stiffness. damping: > 0, or NaN for no value.
DayValue as_stiffness(const DayValue& damping);

/// Returns what a finding about that stiffness says of the damping: ratio is above 0.
YearsWatch::Finding as_damping(YearsWatch::Finding finding);

}  // namespace framewatch::estimator
