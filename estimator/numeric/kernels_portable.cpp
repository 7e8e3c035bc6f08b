#define FRAMEWATCH_VECTOR_BYTES 16
#include "estimator/numeric/kernels_body.h"

namespace framewatch::estimator::kernels {

const Table* portable() {
  return &kTable;
}

}  // namespace framewatch::estimator::kernels
