#include "estimator/numeric/kernels.h"

namespace framewatch::estimator::kernels {
namespace {

const Table* best() {
  if (const Table* table = x86_64_v4()) return table;
  if (const Table* table = x86_64_v3()) return table;
  return portable();
}

}  // namespace

const Table* const in_use = best();

}  // namespace framewatch::estimator::kernels
