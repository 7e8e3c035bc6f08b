// SPDX-License-Identifier: MIT
#define FRAMEWATCH_VECTOR_BYTES 16
#include "estimator/numeric/kernels_body.h"

namespace framewatch::estimator::kernels {
namespace {

const Table* best() {
  if (const Table* table = x86_64_v4()) return table;
  if (const Table* table = x86_64_v3()) return table;
  return portable();
}

}  // namespace

const Table* portable() {
  return &kTable;
}

const Table* const in_use = best();

}  // namespace framewatch::estimator::kernels
