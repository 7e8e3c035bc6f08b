// Kernels of the rows of the regression (filtering them) and of their Gram matrix H^T H. Part of
// kernels_body.h.
#pragma once

#include "estimator/numeric/kernels_vector.h"

namespace framewatch::estimator::kernels {
namespace {

void filter_rows(const double* x, const double* response, int at, const double* gain,
                 const double* a1, const double* a2, double* s1, double* s2, const double* beta,
                 double* h, int rows, int stride) {
  for (int r = 0; r < rows; ++r) {
    const double old1 = s1[at], old2 = s2[at];
    for_lanes(0, stride, [&](auto of, int j) FRAMEWATCH_INLINE {
      using Vector = decltype(of);
      typename Vector::Type s, before, older, weight;
      load<Vector>(s, x + j);
      load<Vector>(before, s1 + j);
      load<Vector>(older, s2 + j);
      s = gain[r] * s - a1[r] * before - a2[r] * older;
      store<Vector>(s2 + j, before);
      store<Vector>(s1 + j, s);
      load<Vector>(weight, beta + j);
      store<Vector>(h + j, weight * s);
    });
    const double s = gain[r] * response[r] - a1[r] * old1 - a2[r] * old2;
    s1[at] = s;
    s2[at] = old1;
    h[at] = beta[at] * s;
    s1 += stride;
    s2 += stride;
    beta += stride;
    h += stride;
  }
}

/// kRows consecutive packed rows of the same length: to = from + sum_r h_r[i..] h_r[first..].
template <int kRows>
inline FRAMEWATCH_INLINE void add_to_rows(const double* from, double* to, const double* h, int rows,
                                          int stride, int i, int first) {
  const int length = stride - first;
  for_lanes(0, length, [&](auto of, int j) FRAMEWATCH_INLINE {
    using Vector = decltype(of);
    typename Vector::Type sum[kRows];
    for (int k = 0; k < kRows; ++k) load<Vector>(sum[k], from + k * length + j);
    for (int r = 0; r < rows; ++r) {
      const double* row = h + r * stride;
      typename Vector::Type v;
      load<Vector>(v, row + first + j);
      for (int k = 0; k < kRows; ++k) sum[k] += row[i + k] * v;
    }
    for (int k = 0; k < kRows; ++k) store<Vector>(to + k * length + j, sum[k]);
  });
}

void add_rows(const double* source, double* destination, const double* h, int rows, int front,
              int stride) {
  static_assert(kLane == 4);  // so many rows start at the same column
  int i = 0;
  for (; i + kLane <= front; i += kLane) {
    add_to_rows<kLane>(source, destination, h, rows, stride, i, i);
    source += kLane * (stride - i);
    destination += kLane * (stride - i);
  }
  if (front - i == 3) add_to_rows<3>(source, destination, h, rows, stride, i, i);
  if (front - i == 2) add_to_rows<2>(source, destination, h, rows, stride, i, i);
  if (front - i == 1) add_to_rows<1>(source, destination, h, rows, stride, i, i);
}

void add(double* __restrict destination, const double* __restrict source, long length) {
  for (long i = 0; i < length; ++i) destination[i] += source[i];
}

void sum_into_front(const double* __restrict a, const double* __restrict b,
                    const double* __restrict c, double scale, const double* __restrict noise,
                    double* __restrict front_rows, int front, int stride) {
  for (int i = 0; i < front; ++i) {
    const int first = packed_row_begin(i);
    const int length = stride - first;
    double* __restrict to = front_rows + i * stride + first;
    for_lanes(0, length, [&](auto of, int j) FRAMEWATCH_INLINE {
      using Vector = decltype(of);
      typename Vector::Type sum, part;
      load<Vector>(sum, a + j);
      load<Vector>(part, b + j);
      sum += part;
      load<Vector>(part, c + j);
      sum += part;
      load<Vector>(part, noise + j);
      sum -= scale * part;
      store<Vector>(to + j, sum);
    });
    a += length;
    b += length;
    c += length;
    noise += length;
  }
}

void subtract_product(const double* packed, const double* __restrict x, double* __restrict score,
                      int front, int stride) {
  constexpr int kParts = kLane / Lane::kLength;
  for (int i = 0; i < front; i += kLane) {
    // Four rows that begin in the same lane: as rows (sum += a x) and, to the right of that lane,
    // transposed (score -= a x_k).
    const double* a[kLane];
    double xk[kLane];
    for (int k = 0; k < kLane; ++k) {
      const bool there = i + k < front;
      a[k] = packed + (there ? k : 0) * (stride - i) - i;
      xk[k] = there ? x[i + k] : 0.0;
    }
    typename Lane::Type sum[kLane][kParts], xs, values, left;
    for (int part = 0; part < kParts; ++part) {
      const int at = i + part * Lane::kLength;
      load<Lane>(xs, x + at);
      for (int k = 0; k < kLane; ++k) {
        load<Lane>(values, a[k] + at);
        sum[k][part] = values * xs;
      }
    }
    for (int j = i + kLane; j < stride; j += kLane) {
      for (int part = 0; part < kParts; ++part) {
        const int at = j + part * Lane::kLength;
        load<Lane>(left, score + at);
        load<Lane>(xs, x + at);
        for (int k = 0; k < kLane; ++k) {
          load<Lane>(values, a[k] + at);
          sum[k][part] += values * xs;
          left -= values * xk[k];
        }
        store<Lane>(score + at, left);
      }
    }
    for (int k = 0; k < kLane && i + k < front; ++k) {
      double lanes[kLane];
      for (int part = 0; part < kParts; ++part)
        store<Lane>(lanes + part * Lane::kLength, sum[k][part]);
      score[i + k] -= (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    }
    packed += kLane * (stride - i);
  }
}

}  // namespace
}  // namespace framewatch::estimator::kernels
