// SPDX-License-Identifier: MIT
// Compiled with -march=x86-64-v3 where the compiler supports it (estimator/CMakeLists.txt).
#include "estimator/numeric/kernels.h"

#ifdef __AVX2__
#define FRAMEWATCH_VECTOR_BYTES 32
#include "estimator/numeric/kernels_body.h"
#endif

namespace framewatch::estimator::kernels {

const Table* x86_64_v3() {
#ifdef __AVX2__
  if (__builtin_cpu_supports("x86-64-v3")) return &kTable;
#endif
  return nullptr;
}

}  // namespace framewatch::estimator::kernels
