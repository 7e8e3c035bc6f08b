// SPDX-License-Identifier: MIT
// Vectors as wide as the registers of one instruction set, and the kernels of the regression:
// filtered rows, Gram matrices, the story-ordered Cholesky factorization, and the boxplot's sorted
// array. kernels_body.h includes this header. The including source defines FRAMEWATCH_VECTOR_BYTES,
// the width of a register.
#pragma once

#include "estimator/numeric/kernels.h"

#define FRAMEWATCH_INLINE __attribute__((always_inline))

namespace framewatch::estimator::kernels {
namespace {

/// A vector of doubles at any address, by the vector extension that g++ and clang offer on every
/// architecture.
template <int kBytes>
struct VectorOf {
  typedef double Type __attribute__((vector_size(kBytes)));
  typedef double Anywhere __attribute__((vector_size(kBytes), aligned(8), may_alias));
  static constexpr int kLength = kBytes / 8;
};
/// Vectors as wide as the registers. The compiler would split wider ones through memory.
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

/// Calls body(vector, j) for j = begin, ... in steps of a vector. begin and end are multiples of a
/// lane.
template <typename Body>
inline FRAMEWATCH_INLINE void for_lanes(int begin, int end, Body body) {
  int j = begin;
  for (; j + Wide::kLength <= end; j += Wide::kLength) body(Wide{}, j);
  if (j < end) body(Lane{}, j);
}

/// Computes the factor's rows of kCount pivots from row `p` on.
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

/// Subtracts the share of kCount pivot rows from kRows rows from `q` on. These rows all start in
/// the same lane.
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

/// Solves for kCount unknowns from `p` on and subtracts their share from the unknowns before them.
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

void apply_taps(const double* taps, const double* recent, int length, int outputs, double* out) {
  for_lanes(0, outputs, [&](auto of, int o) FRAMEWATCH_INLINE {
    using Vector = decltype(of);
    typename Vector::Type sum{}, tap;
    for (int k = 0; k < length; ++k) {
      load<Vector>(tap, taps + k * outputs + o);
      sum += tap * recent[k];
    }
    store<Vector>(out + o, sum);
  });
}

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

/// Adds to kRows consecutive packed rows of equal length: to = from + sum_r h_r[i..] h_r[first..].
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
  static_assert(kLane == 4);  // this many rows start at the same column
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
    // Four rows that begin in the same lane serve twice: as rows (sum += a x) and, right of that
    // lane, transposed (score -= a x_k).
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

/// Returns how many of `length` values satisfy `before`. Avoids branches, because a value's place
/// among the others cannot be predicted.
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
  // One value leaves and one enters, so only the values between them move.
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
