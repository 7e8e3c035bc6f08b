// SPDX-License-Identifier: MIT
// Complex numbers of the frequency domain.
#pragma once

#include <complex>

namespace framewatch::estimator {

using Complex = std::complex<double>;
inline constexpr Complex kJ{0, 1};

}  // namespace framewatch::estimator
