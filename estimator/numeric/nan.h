#pragma once

#include <limits>

namespace framewatch::estimator {

inline constexpr double kNaN =
    std::numeric_limits<double>::quiet_NaN();  ///< stands for a missing value

}  // namespace framewatch::estimator
