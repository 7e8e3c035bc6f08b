// Kernels of diagnose's equations: complex matrices of some frequencies side by side. Part of
// kernels_body.h.
#pragma once

#include "estimator/numeric/kernels_vector.h"

namespace framewatch::estimator::kernels {
namespace {

/// One complex number of some of the kBins frequencies.
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

/// 1 / sqrt(v), not finite where v is not above zero.
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

/// Of a lower triangle whose diagonal, real, is inverted already.
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

}  // namespace
}  // namespace framewatch::estimator::kernels
