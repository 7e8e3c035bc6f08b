// Kernels of the story-ordered Cholesky factorisation of the normal equations. Part of
// kernels_body.h.
#pragma once

#include "estimator/numeric/kernels_vector.h"

namespace framewatch::estimator::kernels {
namespace {

/// kCount pivots from `p` on: the factor's rows.
template <int kCount>
inline FRAMEWATCH_INLINE void take_pivots(const double* rows, double* factor_rows, int p, int front,
                                          int stride, const double* floor, unsigned char* usable) {
  const double* row[kCount];
  double* to[kCount];
  double inverse[kCount];
  double factor[kCount][kCount];
  for (int k = 0; k < kCount; ++k) row[k] = rows + (p + k) * stride;
  for (int k = 0; k < kCount; ++k) to[k] = factor_rows + (p + k) * stride;
  for (int k = 0; k < kCount; ++k) {
    double diagonal = row[k][p + k];
    for (int l = 0; l < k; ++l) diagonal -= factor[l][k] * factor[l][k];
    usable[p + k] = diagonal > floor[p + k] ? 1 : 0;
    inverse[k] = usable[p + k] != 0 ? 1 / __builtin_sqrt(diagonal) : 0.0;
    for (int m = k + 1; m < kCount; ++m) {
      double sum = row[k][p + m];
      for (int l = 0; l < k; ++l) sum -= factor[l][k] * factor[l][m];
      factor[k][m] = sum * inverse[k];
    }
  }
  for_lanes(packed_row_begin(p), stride, [&](auto of, int j) FRAMEWATCH_INLINE {
    using Vector = decltype(of);
    typename Vector::Type done[kCount];
    for (int k = 0; k < kCount; ++k) {
      load<Vector>(done[k], row[k] + j);
      for (int l = 0; l < k; ++l) done[k] -= factor[l][k] * done[l];
      done[k] *= inverse[k];
      store<Vector>(to[k] + j, done[k]);
    }
  });
  for (int k = 0; k < kCount; ++k)
    if (usable[p + k] == 0)
      for (int j = p; j < front; ++j) to[k][j] = 0;
}

/// kRows rows from `q` on, all starting in the same lane, see kCount pivots' rows of the factor.
template <int kCount, int kRows>
inline FRAMEWATCH_INLINE void eliminate(double* rows, const double* pivot, int q, int stride) {
  double* to = rows + q * stride;
  for_lanes(packed_row_begin(q), stride, [&](auto of, int j) FRAMEWATCH_INLINE {
    using Vector = decltype(of);
    typename Vector::Type sum[kRows];
    for (int k = 0; k < kRows; ++k) load<Vector>(sum[k], to + k * stride + j);
    for (int l = 0; l < kCount; ++l) {
      typename Vector::Type v;
      load<Vector>(v, pivot + l * stride + j);
      for (int k = 0; k < kRows; ++k) sum[k] -= pivot[l * stride + q + k] * v;
    }
    for (int k = 0; k < kRows; ++k) store<Vector>(to + k * stride + j, sum[k]);
  });
}

template <int kCount>
inline FRAMEWATCH_INLINE void sweep(double* rows, double* factor, int p, int front, int stride,
                                    const double* floor, unsigned char* usable) {
  take_pivots<kCount>(rows, factor, p, front, stride, floor, usable);
  const double* pivot = factor + p * stride;
  int q = p + kCount;
  for (; q % kLane != 0 && q < front; ++q) eliminate<kCount, 1>(rows, pivot, q, stride);
  for (; q + kLane <= front; q += kLane) eliminate<kCount, kLane>(rows, pivot, q, stride);
  if (front - q == 3) eliminate<kCount, 3>(rows, pivot, q, stride);
  if (front - q == 2) eliminate<kCount, 2>(rows, pivot, q, stride);
  if (front - q == 1) eliminate<kCount, 1>(rows, pivot, q, stride);
}

void partial_cholesky(double* front_rows, double* factor, int pivots, int front, int stride,
                      const double* floor, unsigned char* usable) {
  int p = 0;
  for (; p + 4 <= pivots; p += 4) sweep<4>(front_rows, factor, p, front, stride, floor, usable);
  if (pivots - p == 3) sweep<3>(front_rows, factor, p, front, stride, floor, usable);
  if (pivots - p == 2) sweep<2>(front_rows, factor, p, front, stride, floor, usable);
  if (pivots - p == 1) sweep<1>(front_rows, factor, p, front, stride, floor, usable);
}

/// kCount unknowns from `p` on, and what they take from those before them.
template <int kCount>
inline FRAMEWATCH_INLINE void substitute(const double* factor, int stride, int p, double* x) {
  double known[kCount];
  for (int k = 0; k < kCount; ++k) known[k] = x[p + k];
  for (int k = kCount - 1; k >= 0; --k) {
    const double pivot = factor[(p + k) * stride + p + k];
    known[k] = pivot > 0 ? known[k] * (1 / pivot) : 1.0;
    for (int l = 0; l < k; ++l) known[l] -= factor[(p + l) * stride + p + k] * known[k];
  }
  for (int k = 0; k < kCount; ++k) x[p + k] = known[k];
  for (int q = 0; q < p; ++q) {
    double left = x[q];
    for (int k = kCount - 1; k >= 0; --k) left -= factor[q * stride + p + k] * known[k];
    x[q] = left;
  }
}

void substitute_back(const double* factor, int stride, int own, int next, double* x) {
  for (int p = 0; p < own; ++p) {
    const double* row = factor + p * stride + own;
    double sum[4] = {};
    int j = 0;
    for (; j + 4 <= next; j += 4)
      for (int l = 0; l < 4; ++l) sum[l] += row[j + l] * x[own + j + l];
    for (; j < next; ++j) sum[0] += row[j] * x[own + j];
    x[p] = row[next] - ((sum[0] + sum[1]) + (sum[2] + sum[3]));
  }
  int p = own;
  for (; p >= 4; p -= 4) substitute<4>(factor, stride, p - 4, x);
  if (p == 3) substitute<3>(factor, stride, 0, x);
  if (p == 2) substitute<2>(factor, stride, 0, x);
  if (p == 1) substitute<1>(factor, stride, 0, x);
}

}  // namespace
}  // namespace framewatch::estimator::kernels
