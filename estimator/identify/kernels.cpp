#include "estimator/identify/kernels.h"

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

FRAMEWATCH_CLONES
void partial_cholesky(double* front_rows, int pivots, int front, int stride, const double* floor,
                      unsigned char* usable) {
  for (int p = 0; p < pivots; ++p) {
    double* pivot = front_rows + p * stride;
    usable[p] = pivot[p] > floor[p] ? 1 : 0;
    if (!usable[p]) {
      for (int j = p; j < front; ++j) pivot[j] = 0;
      continue;
    }
    const double inverse = 1 / std::sqrt(pivot[p]);
    for (int j = p; j < front; ++j) pivot[j] *= inverse;
    for (int q = p + 1; q < front; ++q) {
      const int first = packed_row_begin(q);
      const double factor = pivot[q];
      double* __restrict to = front_rows + q * stride + first;
      const double* __restrict from = pivot + first;
      const int length = stride - first;
#pragma GCC ivdep
      for (int j = 0; j < length; ++j) to[j] -= factor * from[j];
    }
  }
}

}  // namespace framewatch::kernels
