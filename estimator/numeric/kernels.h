#pragma once

// The inner loops of the per-sample path and of diagnose, compiled for several instruction sets.
// Arithmetic in a fixed order and no fused multiply-add: all of them give the same bits
// (tests/estimator/numeric/kernels_test).

namespace framewatch::estimator {

/// Length of a front padded to whole vector lanes.
inline constexpr int kLane = 4;
constexpr int padded(int length) {
  return (length + kLane - 1) / kLane * kLane;
}

/// Packed upper rows of a symmetric front: row i holds columns from i rounded down to a lane up to
/// padded(front).
constexpr int packed_row_begin(int i) {
  return i / kLane * kLane;
}

}  // namespace framewatch::estimator

namespace framewatch::estimator::kernels {

/// A sorted array's guide holds its values kGuideStep - 1, 2 kGuideStep - 1, ...
inline constexpr int kGuideStep = 16;
/// Its own length is a multiple of this.
inline constexpr int kGuidePadding = 8;

/// So many frequencies are worked on at once. A complex number of all of them is their real parts,
/// then their imaginary parts.
inline constexpr int kBins = 8;

struct Table {
  /// One step of a floor's row filters: per row, s = gain x - a1 s1 - a2 s2; s2 = s1; s1 = s;
  /// h = beta s. x is common to all rows but for entry `at`, which is the row's response. x:
  /// stride; response, gain, a1, a2: rows; the others rows x stride.
  void (*filter_rows)(const double* x, const double* response, int at, const double* gain,
                      const double* a1, const double* a2, double* s1, double* s2,
                      const double* beta, double* h, int rows, int stride);

  /// destination = source + sum_r h_r h_r^T on the packed upper rows of a front
  /// (docs/equations.md): row i holds columns from i rounded down to a lane up to `stride`, those
  /// left of the diagonal a repetition. h: rows x stride.
  void (*add_rows)(const double* source, double* destination, const double* h, int rows, int front,
                   int stride);

  /// destination += source.
  void (*add)(double* destination, const double* source, long length);

  /// Unpacks a + b + c - scale noise into the rows of a stride x stride upper front.
  void (*sum_into_front)(const double* a, const double* b, const double* c, double scale,
                         const double* noise, double* front_rows, int front, int stride);

  /// Right-looking partial Cholesky of the first `pivots` unknowns of an upper front: their rows of
  /// the factor go to `factor`, pivots x stride, which may be the front's own; the rest of the
  /// front becomes the Schur complement. A pivot not above floor[i] is given up: its row becomes
  /// zero and usable[i] false.
  void (*partial_cholesky)(double* front_rows, double* factor, int pivots, int front, int stride,
                           const double* floor, unsigned char* usable);

  /// x_own = U^-1 (right - W x_next) from rows [U W right] of a partial Cholesky's factor; x holds
  /// own, then next values. An unknown with a zero row becomes 1.
  void (*substitute_back)(const double* factor, int stride, int own, int next, double* x);

  /// In place and from rows of a partial Cholesky's factor, [U W], `own` x stride: right-hand sides
  /// X (own + next rows x columns, row-major, columns a multiple of a lane) become U^-T X_own, and
  /// X_next - W^T of it. A zero row of the factor gives a zero row.
  void (*forward_columns)(const double* factor, int stride, int own, int next, double* x,
                          int columns);

  /// The other half: X_own becomes U^-1 (X_own - W X_next).
  void (*backward_columns)(const double* factor, int stride, int own, int next, double* x,
                           int columns);

  /// out += a b; a: rows x inner with stride a_stride, b and out row-major with `columns` columns.
  void (*multiply_add)(const double* a, int a_stride, int rows, int inner, const double* b,
                       double* out, int columns);

  /// out += a x + b y; columns: a multiple of a lane.
  void (*add_two)(double a, const double* x, double b, const double* y, double* out, int columns);

  /// score -= A x for a symmetric front A in packed rows; x and score `stride` long, x zero beyond
  /// the front.
  void (*subtract_product)(const double* packed, const double* x, double* score, int front,
                           int stride);

  /// Takes `leaving`, which is there, out of an ascending array and puts `entering` in. size: a
  /// multiple of kGuideStep; guide_size: size / kGuideStep, padded with infinities.
  /// Infinity fills what is unused.
  void (*replace_sorted)(double* sorted, int size, double* guide, int guide_size, double leaving,
                         double entering);

  /// covariance = sum_a noise_a d_a d_a^H at kBins frequencies, its lower triangle. d: n x axes and
  /// covariance: n x n complex numbers, row-major; noise: axes x kBins. d is zero before first[row]
  /// and from end[row] on.
  void (*noise_covariance)(const double* d, const double* noise, const int* first, const int* end,
                           int n, int axes, double* covariance);

  /// In place, n x n complex numbers at kBins frequencies, lower triangles: a Hermitian matrix
  /// becomes the inverse of its Cholesky factor. Not finite where it is not positive definite.
  /// first: of every row the column before which the matrix is zero.
  void (*inverse_cholesky)(double* matrix, const int* first, int n);
};

/// Null where the machine or the compiler does not have the instruction set.
const Table* portable();
const Table* x86_64_v3();  ///< AVX2
const Table* x86_64_v4();  ///< AVX-512

/// The widest one this machine has. Not for use before main().
extern const Table* const in_use;

}  // namespace framewatch::estimator::kernels
