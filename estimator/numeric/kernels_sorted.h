// Kernels of a sorted array of fixed length, the boxplot's. Part of
// kernels_body.h.
#pragma once

#include "estimator/numeric/kernels_vector.h"

namespace framewatch::estimator::kernels {
namespace {

/// How many of `length` values come before `value`: without branches, because where a value lies
/// among others nobody can predict.
template <typename Before>
inline FRAMEWATCH_INLINE int count_before(const double* values, int length, Before before) {
  static_assert(kGuidePadding % Wide::kLength == 0 && kGuideStep % Wide::kLength == 0);
  Wide::Type v;
  decltype(v < v) count = {};
  for (int j = 0; j < length; j += Wide::kLength) {
    load<Wide>(v, values + j);
    count -= before(v);
  }
  long total = 0;
  for (int k = 0; k < Wide::kLength; ++k) total += count[k];
  return static_cast<int>(total);
}

template <typename Before>
inline FRAMEWATCH_INLINE int place_of(const double* sorted, int size, const double* guide,
                                      int guide_size, Before before) {
  const int begin = kGuideStep * count_before(guide, guide_size, before);
  return begin < size ? begin + count_before(sorted + begin, kGuideStep, before) : size;
}

void replace_sorted(double* sorted, int size, double* guide, int guide_size, double leaving,
                    double entering) {
  const int from = place_of(sorted, size, guide, guide_size,
                            [&](const auto& v) FRAMEWATCH_INLINE { return v < leaving; });
  const int to = place_of(sorted, size, guide, guide_size,
                          [&](const auto& v) FRAMEWATCH_INLINE { return v <= entering; });
  // One value out, one in: only what lies between them moves.
  Wide::Type v;
  int i = from;
  if (from < to) {
    for (; i + Wide::kLength < to; i += Wide::kLength) {
      load<Wide>(v, sorted + i + 1);
      store<Wide>(sorted + i, v);
    }
    for (; i + 1 < to; ++i) sorted[i] = sorted[i + 1];
  } else {
    for (; i - Wide::kLength >= to; i -= Wide::kLength) {
      load<Wide>(v, sorted + i - Wide::kLength);
      store<Wide>(sorted + i - Wide::kLength + 1, v);
    }
    for (; i > to; --i) sorted[i] = sorted[i - 1];
  }
  sorted[i] = entering;
  const int last = (from < to ? to - 1 : from) / kGuideStep;
  for (int k = (from < to ? from : to) / kGuideStep; k <= last; ++k)
    guide[k] = sorted[(k + 1) * kGuideStep - 1];
}

}  // namespace
}  // namespace framewatch::estimator::kernels
