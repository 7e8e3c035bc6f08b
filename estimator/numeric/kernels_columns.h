// Kernels of right-hand sides with many columns, and of matrix products. Part of
// kernels_body.h.
#pragma once

#include <type_traits>

#include "estimator/numeric/kernels_vector.h"

namespace framewatch::estimator::kernels {
namespace {

/// So many vectors of columns stay in registers at a time.
constexpr int kAtOnce = 5;

template <typename Vector, int kCount>
inline FRAMEWATCH_INLINE void load_some(typename Vector::Type* v, const double* from) {
  for (int c = 0; c < kCount; ++c) load<Vector>(v[c], from + c * Vector::kLength);
}
template <typename Vector, int kCount>
inline FRAMEWATCH_INLINE void store_some(double* to, const typename Vector::Type* v) {
  for (int c = 0; c < kCount; ++c) store<Vector>(to + c * Vector::kLength, v[c]);
}

template <typename Vector, int kCount>
inline FRAMEWATCH_INLINE void forward_some(const double* factor, int stride, int own, int next,
                                           double* x, int columns) {
  typename Vector::Type sum[kCount], known[kCount];
  for (int p = 0; p < own + next; ++p) {
    load_some<Vector, kCount>(sum, x + p * columns);
    const int done = p < own ? p : own;
    for (int j = 0; j < done; ++j) {
      load_some<Vector, kCount>(known, x + j * columns);
      for (int c = 0; c < kCount; ++c) sum[c] -= factor[j * stride + p] * known[c];
    }
    if (p < own) {
      const double pivot = factor[p * stride + p];
      const double inverse = pivot > 0 ? 1 / pivot : 0.0;
      for (int c = 0; c < kCount; ++c) sum[c] *= inverse;
    }
    store_some<Vector, kCount>(x + p * columns, sum);
  }
}

template <typename Vector, int kCount>
inline FRAMEWATCH_INLINE void backward_some(const double* factor, int stride, int own, int next,
                                            double* x, int columns) {
  typename Vector::Type sum[kCount], known[kCount];
  for (int p = own - 1; p >= 0; --p) {
    const double* row = factor + p * stride;
    load_some<Vector, kCount>(sum, x + p * columns);
    for (int j = p + 1; j < own + next; ++j) {
      load_some<Vector, kCount>(known, x + j * columns);
      for (int c = 0; c < kCount; ++c) sum[c] -= row[j] * known[c];
    }
    const double inverse = row[p] > 0 ? 1 / row[p] : 0.0;
    for (int c = 0; c < kCount; ++c) sum[c] *= inverse;
    store_some<Vector, kCount>(x + p * columns, sum);
  }
}

template <typename Vector, int kRows, int kCount>
inline FRAMEWATCH_INLINE void multiply_rows(const double* a, int a_stride, int inner,
                                            const double* b, double* out, int columns) {
  typename Vector::Type sum[kRows][kCount], part;
  for (int k = 0; k < kRows; ++k) load_some<Vector, kCount>(sum[k], out + k * columns);
  for (int j = 0; j < inner; ++j)
    for (int c = 0; c < kCount; ++c) {
      load<Vector>(part, b + j * columns + c * Vector::kLength);
      for (int k = 0; k < kRows; ++k) sum[k][c] += a[k * a_stride + j] * part;
    }
  for (int k = 0; k < kRows; ++k) store_some<Vector, kCount>(out + k * columns, sum[k]);
}

template <typename Vector, int kCount>
inline FRAMEWATCH_INLINE void multiply_some(const double* a, int a_stride, int rows, int inner,
                                            const double* b, double* out, int columns) {
  int r = 0;
  for (; r + 2 <= rows; r += 2)
    multiply_rows<Vector, 2, kCount>(a + r * a_stride, a_stride, inner, b, out + r * columns,
                                     columns);
  if (r < rows)
    multiply_rows<Vector, 1, kCount>(a + r * a_stride, a_stride, inner, b, out + r * columns,
                                     columns);
}

/// body(vector, count, column) for as many vectors of columns as stay in registers at a time.
template <typename Body>
inline FRAMEWATCH_INLINE void for_columns(int columns, Body body) {
  constexpr int kWide = kAtOnce * Wide::kLength;
  constexpr int kNarrow = kAtOnce * Lane::kLength;
  int c = 0;
  for (; c + kWide <= columns; c += kWide) body(Wide{}, std::integral_constant<int, kAtOnce>{}, c);
  for (; c + kNarrow <= columns; c += kNarrow)
    body(Lane{}, std::integral_constant<int, kAtOnce>{}, c);
  for (; c + 3 * Lane::kLength <= columns; c += 3 * Lane::kLength)
    body(Lane{}, std::integral_constant<int, 3>{}, c);
  for (; c < columns; c += Lane::kLength) body(Lane{}, std::integral_constant<int, 1>{}, c);
}

void forward_columns(const double* factor, int stride, int own, int next, double* x, int columns) {
  for_columns(columns, [&](auto of, auto count, int c) FRAMEWATCH_INLINE {
    forward_some<decltype(of), count()>(factor, stride, own, next, x + c, columns);
  });
}

void backward_columns(const double* factor, int stride, int own, int next, double* x, int columns) {
  for_columns(columns, [&](auto of, auto count, int c) FRAMEWATCH_INLINE {
    backward_some<decltype(of), count()>(factor, stride, own, next, x + c, columns);
  });
}

void multiply_add(const double* a, int a_stride, int rows, int inner, const double* b, double* out,
                  int columns) {
  for_columns(columns, [&](auto of, auto count, int c) FRAMEWATCH_INLINE {
    multiply_some<decltype(of), count()>(a, a_stride, rows, inner, b + c, out + c, columns);
  });
}

void add_two(double a, const double* x, double b, const double* y, double* out, int columns) {
  for_lanes(0, columns, [&](auto of, int j) FRAMEWATCH_INLINE {
    using Vector = decltype(of);
    typename Vector::Type sum, one, other;
    load<Vector>(sum, out + j);
    load<Vector>(one, x + j);
    load<Vector>(other, y + j);
    sum += a * one + b * other;
    store<Vector>(out + j, sum);
  });
}

}  // namespace
}  // namespace framewatch::estimator::kernels
