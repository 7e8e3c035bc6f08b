// Compiled with -march=x86-64-v4 where there is such a thing (estimator/CMakeLists.txt).
#include "estimator/identify/kernels.h"

#ifdef __AVX512F__

#define FRAMEWATCH_VECTOR_BYTES 64
#include "estimator/identify/kernels_body.h"

namespace framewatch::kernels {

const Table* x86_64_v4() {
  return __builtin_cpu_supports("x86-64-v4") ? &kTable : nullptr;
}

}  // namespace framewatch::kernels

#else

namespace framewatch::kernels {

const Table* x86_64_v4() {
  return nullptr;
}

}  // namespace framewatch::kernels

#endif
