// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace framewatch::estimator {

/// Stands for a missing value.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace framewatch::estimator
