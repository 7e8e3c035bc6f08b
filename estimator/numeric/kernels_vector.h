// Vectors of the kernels (kernels_body.h), as wide as the instruction set's.
// FRAMEWATCH_VECTOR_BYTES: width of its registers.
#pragma once

#include "estimator/numeric/kernels.h"

#define FRAMEWATCH_INLINE __attribute__((always_inline))

namespace framewatch::estimator::kernels {
namespace {

/// A vector of doubles as g++ and clang offer it on every architecture, at any address.
template <int kBytes>
struct VectorOf {
  typedef double Type __attribute__((vector_size(kBytes)));
  typedef double Anywhere __attribute__((vector_size(kBytes), aligned(8), may_alias));
  static constexpr int kLength = kBytes / 8;
};
/// As wide as the registers: wider ones the compiler would take apart through memory.
using Wide = VectorOf<FRAMEWATCH_VECTOR_BYTES>;
using Lane = VectorOf < FRAMEWATCH_VECTOR_BYTES<8 * kLane ? FRAMEWATCH_VECTOR_BYTES : 8 * kLane>;

template <typename Vector>
inline FRAMEWATCH_INLINE void load(typename Vector::Type& v, const double* from) {
  v = *reinterpret_cast<const typename Vector::Anywhere*>(from);
}
template <typename Vector>
inline FRAMEWATCH_INLINE void store(double* to, const typename Vector::Type& v) {
  *reinterpret_cast<typename Vector::Anywhere*>(to) = v;
}

/// body(vector, j) for j = begin, ... in steps of a vector; begin and end multiples of a lane.
template <typename Body>
inline FRAMEWATCH_INLINE void for_lanes(int begin, int end, Body body) {
  int j = begin;
  for (; j + Wide::kLength <= end; j += Wide::kLength) body(Wide{}, j);
  if (j < end) body(Lane{}, j);
}

}  // namespace
}  // namespace framewatch::estimator::kernels
