#define FRAMEWATCH_VECTOR_BYTES 16
#include "estimator/identify/kernels_body.h"

namespace framewatch::kernels {

const Table* portable() {
  return &kTable;
}

}  // namespace framewatch::kernels
