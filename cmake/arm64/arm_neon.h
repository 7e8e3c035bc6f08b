// SPDX-License-Identifier: MIT
// Eigen includes this instead of the compiler's arm_neon.h (cmake/SameBits.cmake). It replaces a
// fused multiply-add, which rounds once, by a product and a sum, which round twice, as on amd64.
#pragma once

#include_next <arm_neon.h>

// NOLINTBEGIN(cppcoreguidelines-macro-usage): they must hide the functions of these names.
#define vfmaq_f64(sum, a, b) vaddq_f64(sum, vmulq_f64(a, b))
#define vfmaq_n_f64(sum, a, b) vaddq_f64(sum, vmulq_n_f64(a, b))
#define vfmaq_laneq_f64(sum, a, b, lane) vaddq_f64(sum, vmulq_laneq_f64(a, b, lane))
#define vfmsq_f64(sum, a, b) vsubq_f64(sum, vmulq_f64(a, b))
// NOLINTEND(cppcoreguidelines-macro-usage)
