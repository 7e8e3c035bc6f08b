// SPDX-License-Identifier: MIT
// All kernels, compiled for one instruction set. One source per instruction set includes this
// header and defines FRAMEWATCH_VECTOR_BYTES first. Here are the kernels of diagnose (complex
// matrices of several frequencies side by side) and of right-hand sides with many columns;
// kernels_regression.h has the others.
//
// Nothing here may leave a symbol that another source could share, so no function of the standard
// library is called.

#include <type_traits>

#include "estimator/numeric/kernels.h"
#include "estimator/numeric/kernels_regression.h"

namespace framewatch::estimator::kernels {
namespace {

/// A complex number at as many of the kBins frequencies as a vector holds.
template <typename Vector>
struct Complex {
  typename Vector::Type re, im;
};

template <typename Vector>
inline FRAMEWATCH_INLINE void load(Complex<Vector>& v, const double* from) {
  load<Vector>(v.re, from);
  load<Vector>(v.im, from + kBins);
}
template <typename Vector>
inline FRAMEWATCH_INLINE void store(double* to, const Complex<Vector>& v) {
  store<Vector>(to, v.re);
  store<Vector>(to + kBins, v.im);
}
/// sum -= a conj(b).
template <typename Vector>
inline FRAMEWATCH_INLINE void subtract_conjugate(Complex<Vector>& sum, const Complex<Vector>& a,
                                                 const Complex<Vector>& b) {
  sum.re -= a.re * b.re;
  sum.re -= a.im * b.im;
  sum.im -= a.im * b.re;
  sum.im += a.re * b.im;
}

inline int larger(int a, int b) {
  return a > b ? a : b;
}

void noise_covariance(const double* d, const double* noise, const int* first, const int* end, int n,
                      int axes, double* covariance) {
  constexpr int kNumber = 2 * kBins;
  for_lanes(0, kBins, [&](auto of, int bin) FRAMEWATCH_INLINE {
    using Vector = decltype(of);
    const double* from = d + bin;
    double* to = covariance + bin;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) {
        Complex<Vector> sum{}, a, b;
        typename Vector::Type variance;
        const int last = end[i] < end[j] ? end[i] : end[j];
        for (int axis = larger(first[i], first[j]); axis < last; ++axis) {
          load<Vector>(a, from + (i * axes + axis) * kNumber);
          load<Vector>(b, from + (j * axes + axis) * kNumber);
          load<Vector>(variance, noise + axis * kBins + bin);
          b.re *= variance;
          b.im *= variance;
          subtract_conjugate(sum, a, b);
        }
        sum.re = -sum.re;
        sum.im = -sum.im;
        store<Vector>(to + (i * n + j) * kNumber, sum);
      }
  });
}

/// Replaces v by 1 / sqrt(v). The result is not finite where v is not positive.
template <typename Vector>
inline FRAMEWATCH_INLINE void inverse_root(typename Vector::Type& v) {
  for (int l = 0; l < Vector::kLength; ++l) v[l] = v[l] > 0 ? __builtin_sqrt(v[l]) : 0.0;
  v = 1 / v;
}

template <typename Vector>
inline FRAMEWATCH_INLINE void factorise(double* matrix, const int* first, int n) {
  constexpr int kNumber = 2 * kBins;
  const auto at = [&](int i, int j) FRAMEWATCH_INLINE { return matrix + (i * n + j) * kNumber; };
  Complex<Vector> sum, a, b;
  for (int j = 0; j < n; ++j) {
    load<Vector>(sum, at(j, j));
    for (int k = first[j]; k < j; ++k) {
      load<Vector>(a, at(j, k));
      subtract_conjugate(sum, a, a);
    }
    typename Vector::Type inverse = sum.re;
    inverse_root<Vector>(inverse);
    store<Vector>(at(j, j), {inverse, sum.im - sum.im});
    for (int i = j + 1; i < n; ++i) {
      if (first[i] > j) continue;
      load<Vector>(sum, at(i, j));
      for (int k = larger(first[i], first[j]); k < j; ++k) {
        load<Vector>(a, at(i, k));
        load<Vector>(b, at(j, k));
        subtract_conjugate(sum, a, b);
      }
      sum.re *= inverse;
      sum.im *= inverse;
      store<Vector>(at(i, j), sum);
    }
  }
}

/// Inverts a lower triangle in place. Its real diagonal must already be inverted.
template <typename Vector>
inline FRAMEWATCH_INLINE void invert_triangle(double* matrix, const int* first, int n) {
  constexpr int kNumber = 2 * kBins;
  const auto at = [&](int i, int j) FRAMEWATCH_INLINE { return matrix + (i * n + j) * kNumber; };
  Complex<Vector> sum, a, b;
  typename Vector::Type inverse;
  for (int j = 0; j < n; ++j)
    for (int i = j + 1; i < n; ++i) {
      sum = Complex<Vector>{};
      for (int k = larger(j, first[i]); k < i; ++k) {
        load<Vector>(a, at(i, k));
        load<Vector>(b, at(k, j));
        b.im = -b.im;
        subtract_conjugate(sum, a, b);
      }
      load<Vector>(inverse, at(i, i));
      sum.re *= inverse;
      sum.im *= inverse;
      store<Vector>(at(i, j), sum);
    }
}

void inverse_cholesky(double* matrix, const int* first, int n) {
  for_lanes(0, kBins, [&](auto of, int bin) FRAMEWATCH_INLINE {
    factorise<decltype(of)>(matrix + bin, first, n);
    invert_triangle<decltype(of)>(matrix + bin, first, n);
  });
}

/// Number of column vectors that stay in registers at a time.
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

/// Calls body(vector, count, column) for as many column vectors as stay in registers at a time.
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

constexpr Table kTable = {apply_taps,       filter_rows,      add_rows,        add,
                          sum_into_front,   partial_cholesky, substitute_back, forward_columns,
                          backward_columns, multiply_add,     add_two,         subtract_product,
                          replace_sorted,   noise_covariance, inverse_cholesky};

}  // namespace
}  // namespace framewatch::estimator::kernels
