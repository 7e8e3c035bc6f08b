// SPDX-License-Identifier: MIT
#pragma once

// The inner loops of the per-sample path and of diagnose, compiled once per instruction set. They
// add and multiply in a fixed order without fused multiply-add, so every instruction set gives the
// same bits (tests/estimator/numeric/kernels_test).

namespace framewatch::estimator {

/// Doubles in a lane. A front, the dense block of one floor's equations, is padded to whole lanes.
inline constexpr int kLane = 4;
constexpr int padded(int length) {
  return (length + kLane - 1) / kLane * kLane;
}

/// Returns the first column that packed row i of a symmetric front holds: i rounded down to a whole
/// lane. The row ends at padded(front).
constexpr int packed_row_begin(int i) {
  return i / kLane * kLane;
}

}  // namespace framewatch::estimator

namespace framewatch::estimator::kernels {

/// Step between the values that a sorted array's guide holds: those at kGuideStep - 1, 2 kGuideStep
/// - 1, ...
inline constexpr int kGuideStep = 16;
/// The length of a guide is a multiple of this.
inline constexpr int kGuidePadding = 8;

/// Frequencies that a kernel processes at once. A complex number at all of them is stored as their
/// real parts, then their imaginary parts.
inline constexpr int kBins = 8;

struct Table {
  /// Computes `outputs` responses of finite length to one signal: out_o = sum_k taps_ko recent_k.
  /// taps: length x outputs. outputs: a multiple of a lane.
  void (*apply_taps)(const double* taps, const double* recent, int length, int outputs,
                     double* out);

  /// Advances a floor's row filters by one step. For each row: s = gain x - a1 s1 - a2 s2; s2 = s1;
  /// s1 = s; h = beta s. All rows share x, except that entry `at` is the row's response. x has
  /// `stride` values; response, gain, a1 and a2 have `rows`; the others have rows x stride.
  void (*filter_rows)(const double* x, const double* response, int at, const double* gain,
                      const double* a1, const double* a2, double* s1, double* s2,
                      const double* beta, double* h, int rows, int stride);

  /// destination = source + sum_r h_r h_r^T on the packed upper rows of a front
  /// (docs/equations.md). Row i holds the columns from i, rounded down to a lane, up to `stride`;
  /// entries left of the diagonal are redundant. h: rows x stride.
  void (*add_rows)(const double* source, double* destination, const double* h, int rows, int front,
                   int stride);

  /// destination += source.
  void (*add)(double* destination, const double* source, long length);

  /// Unpacks a + b + c - scale noise into the rows of a stride x stride upper front.
  void (*sum_into_front)(const double* a, const double* b, const double* c, double scale,
                         const double* noise, double* front_rows, int front, int stride);

  /// Factors the first `pivots` unknowns of an upper front (right-looking partial Cholesky). Their
  /// rows of the factor go to `factor`, pivots x stride, which may be the front's own memory. The
  /// rest of the front becomes the Schur complement. If pivot i does not exceed floor[i], its row
  /// becomes zero and usable[i] becomes 0.
  void (*partial_cholesky)(double* front_rows, double* factor, int pivots, int front, int stride,
                           const double* floor, unsigned char* usable);

  /// Computes x_own = U^-1 (right - W x_next) from the rows [U W right] of a partial Cholesky
  /// factor. x holds the own values, then the next ones. An unknown whose row is zero becomes 1.
  void (*substitute_back)(const double* factor, int stride, int own, int next, double* x);

  /// Solves the forward half in place with the rows [U W] of a partial Cholesky factor, `own` x
  /// stride. X has own + next rows and `columns` columns, row-major, a multiple of a lane. X_own
  /// becomes U^-T X_own, and X_next becomes X_next - W^T X_own. A zero row of the factor gives a
  /// zero row.
  void (*forward_columns)(const double* factor, int stride, int own, int next, double* x,
                          int columns);

  /// Solves the backward half: X_own becomes U^-1 (X_own - W X_next).
  void (*backward_columns)(const double* factor, int stride, int own, int next, double* x,
                           int columns);

  /// out += a b. a: rows x inner with stride a_stride. b and out are row-major with `columns`
  /// columns.
  void (*multiply_add)(const double* a, int a_stride, int rows, int inner, const double* b,
                       double* out, int columns);

  /// out += a x + b y. columns: a multiple of a lane.
  void (*add_two)(double a, const double* x, double b, const double* y, double* out, int columns);

  /// score -= A x for a symmetric front A in packed rows. x and score have `stride` values; x is
  /// zero beyond the front.
  void (*subtract_product)(const double* packed, const double* x, double* score, int front,
                           int stride);

  /// Removes `leaving`, which must be present, from an ascending array and inserts `entering`.
  /// size: a multiple of kGuideStep. guide_size: size / kGuideStep, padded to kGuidePadding. Unused
  /// places hold infinity.
  void (*replace_sorted)(double* sorted, int size, double* guide, int guide_size, double leaving,
                         double entering);

  /// covariance = sum_a noise_a d_a d_a^H at kBins frequencies, lower triangle only. d (n x axes)
  /// and covariance (n x n) hold complex numbers, row-major; noise is axes x kBins. Row i of d is
  /// zero before first[i] and from end[i] on.
  void (*noise_covariance)(const double* d, const double* noise, const int* first, const int* end,
                           int n, int axes, double* covariance);

  /// Replaces a Hermitian matrix by the inverse of its Cholesky factor, at kBins frequencies, lower
  /// triangle, n x n. The result is not finite where the matrix is not positive definite. Row i of
  /// the matrix is zero before column first[i].
  void (*inverse_cholesky)(double* matrix, const int* first, int n);
};

/// Return the table of one instruction set, or nullptr if the machine or the compiler does not
/// support it.
const Table* portable();
const Table* x86_64_v3();  ///< AVX2
const Table* x86_64_v4();  ///< AVX-512

/// The table of the widest instruction set that this machine supports. Do not use it before main().
extern const Table* const in_use;

}  // namespace framewatch::estimator::kernels
