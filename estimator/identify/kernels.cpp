#include "estimator/identify/kernels.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/row_tuning.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FRAMEWATCH_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define FRAMEWATCH_CLONES
#endif

namespace framewatch::kernels {

FRAMEWATCH_CLONES
void filter_row(const double* __restrict x, double gain, double a1, double a2,
                double* __restrict s1, double* __restrict s2, const double* __restrict beta,
                double* __restrict h, int length) {
  for (int i = 0; i < length; ++i) {
    const double s = gain * x[i] - a1 * s1[i] - a2 * s2[i];
    s2[i] = s1[i];
    s1[i] = s;
    h[i] = beta[i] * s;
  }
}

FRAMEWATCH_CLONES
void add_rows(const double* source, double* destination, const double* h, int rows, int front,
              int stride) {
  for (int i = 0; i < front; ++i) {
    const int first = packed_row_begin(i);
    const int length = stride - first;
    const double* __restrict from = source;
    double* to = destination;
    int r = 0;
    if (rows >= 4) {
      for (; r + 4 <= rows; r += 4) {
        const double* __restrict h0 = h + r * stride + first;
        const double* __restrict h1 = h0 + stride;
        const double* __restrict h2 = h1 + stride;
        const double* __restrict h3 = h2 + stride;
        const int at = i - first;
        const double c0 = h0[at], c1 = h1[at], c2 = h2[at], c3 = h3[at];
#pragma GCC ivdep
        for (int j = 0; j < length; ++j) {
          double sum = from[j];
          sum += c0 * h0[j];
          sum += c1 * h1[j];
          sum += c2 * h2[j];
          sum += c3 * h3[j];
          to[j] = sum;
        }
        from = to;
      }
    }
    for (; r < rows; ++r) {
      const double* __restrict h0 = h + r * stride + first;
      const double c0 = h0[i - first];
#pragma GCC ivdep
      for (int j = 0; j < length; ++j) to[j] = from[j] + c0 * h0[j];
      from = to;
    }
    if (rows == 0 && from != to)
      for (int j = 0; j < length; ++j) to[j] = from[j];
    source += length;
    destination += length;
  }
}

FRAMEWATCH_CLONES
void add(double* __restrict destination, const double* __restrict source, long length) {
  for (long i = 0; i < length; ++i) destination[i] += source[i];
}

FRAMEWATCH_CLONES
void sum_into_front(const double* __restrict a, const double* __restrict b,
                    const double* __restrict c, double scale, const double* __restrict noise,
                    double* __restrict front_rows, int front, int stride) {
  for (int i = 0; i < front; ++i) {
    const int first = packed_row_begin(i);
    const int length = stride - first;
    double* __restrict to = front_rows + i * stride + first;
    for (int j = 0; j < length; ++j) to[j] = a[j] + b[j] + c[j] - scale * noise[j];
    a += length;
    b += length;
    c += length;
    noise += length;
  }
}

namespace {

/// Takes pivot row `p` ready for use: scaled by the root of its diagonal, or zero if given up.
inline bool scale_pivot(double* row, int p, int front, double floor) {
  if (!(row[p] > floor)) {
    for (int j = p; j < front; ++j) row[j] = 0;
    return false;
  }
  const double inverse = 1 / std::sqrt(row[p]);
  for (int j = p; j < front; ++j) row[j] *= inverse;
  return true;
}

}  // namespace

FRAMEWATCH_CLONES
void partial_cholesky(double* front_rows, int pivots, int front, int stride, const double* floor,
                      unsigned char* usable) {
  constexpr int kAtOnce = 4;
  for (int p = 0; p < pivots; p += kAtOnce) {
    const int count = std::min(kAtOnce, pivots - p);
    for (int k = 0; k < count; ++k) {
      double* pivot = front_rows + (p + k) * stride;
      for (int l = 0; l < k; ++l) {
        const double* __restrict from = front_rows + (p + l) * stride;
        const double factor = from[p + k];
#pragma GCC ivdep
        for (int j = packed_row_begin(p + k); j < stride; ++j) pivot[j] -= factor * from[j];
      }
      usable[p + k] = scale_pivot(pivot, p + k, front, floor[p + k]) ? 1 : 0;
    }
    // Rows that are no pivots of this group see all of its pivots in one pass.
    const double* __restrict p0 = front_rows + p * stride;
    const double* __restrict p1 = count > 1 ? p0 + stride : p0;
    const double* __restrict p2 = count > 2 ? p0 + 2 * stride : p0;
    const double* __restrict p3 = count > 3 ? p0 + 3 * stride : p0;
    for (int q = p + count; q < front; ++q) {
      const double f0 = p0[q];
      const double f1 = count > 1 ? p1[q] : 0.0;
      const double f2 = count > 2 ? p2[q] : 0.0;
      const double f3 = count > 3 ? p3[q] : 0.0;
      double* __restrict to = front_rows + q * stride;
#pragma GCC ivdep
      for (int j = packed_row_begin(q); j < stride; ++j) {
        double sum = to[j];
        sum -= f0 * p0[j];
        sum -= f1 * p1[j];
        sum -= f2 * p2[j];
        sum -= f3 * p3[j];
        to[j] = sum;
      }
    }
  }
}

}  // namespace framewatch::kernels
