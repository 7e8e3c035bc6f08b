// SPDX-License-Identifier: MIT
// Compiled with -march=x86-64-v4 where the compiler supports it (estimator/CMakeLists.txt).
#include "estimator/numeric/kernels.h"

#ifdef __AVX512F__
#define FRAMEWATCH_VECTOR_BYTES 64
#include "estimator/numeric/kernels_body.h"
#endif

namespace framewatch::estimator::kernels {

const Table* x86_64_v4() {
#ifdef __AVX512F__
  if (__builtin_cpu_supports("x86-64-v4")) return &kTable;
#endif
  return nullptr;
}

}  // namespace framewatch::estimator::kernels
