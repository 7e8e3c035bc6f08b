// SPDX-License-Identifier: MIT
// Eigen's vectors of doubles on arm64 without fused multiply-add: this header replaces the compiler's arm_neon.h, which
// Eigen includes (cmake/SameBits.cmake). A fused multiply-add rounds once, a product and a sum round twice, as on amd64.
#pragma once

#include_next <arm_neon.h>

// NOLINTBEGIN(cppcoreguidelines-macro-usage): they must hide the functions of these names.
#define vfmaq_f64(sum, a, b) vaddq_f64(sum, vmulq_f64(a, b))
#define vfmaq_n_f64(sum, a, b) vaddq_f64(sum, vmulq_n_f64(a, b))
#define vfmaq_laneq_f64(sum, a, b, lane) vaddq_f64(sum, vmulq_laneq_f64(a, b, lane))
#define vfmsq_f64(sum, a, b) vsubq_f64(sum, vmulq_f64(a, b))
// NOLINTEND(cppcoreguidelines-macro-usage)
