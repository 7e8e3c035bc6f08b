#pragma once

// The inner loops of the per-sample path. Only element-wise arithmetic, no reductions and no fused
// multiply-add, so every instruction set the loader picks (target_clones) gives the same bits.

namespace framewatch::kernels {

/// s = gain x - a1 s1 - a2 s2; s2 = s1; s1 = s; h = beta s. All `length` long.
void filter_row(const double* x, double gain, double a1, double a2, double* s1, double* s2,
                const double* beta, double* h, int length);

/// destination = source + sum_r h_r h_r^T on the packed upper rows of a front (docs/equations.md):
/// row i holds columns from i rounded down to a lane up to `stride`. h: rows x stride.
void add_rows(const double* source, double* destination, const double* h, int rows, int front,
              int stride);

/// destination += source.
void add(double* destination, const double* source, long length);

/// Unpacks a + b + c - scale noise into the rows of a stride x stride upper front.
void sum_into_front(const double* a, const double* b, const double* c, double scale,
                    const double* noise, double* front_rows, int front, int stride);

/// Right-looking partial Cholesky of the first `pivots` unknowns of an upper front, in place: the
/// pivot rows become the factor's, the rest the Schur complement. A pivot not above floor[i] is
/// given up: its row becomes zero and usable[i] false.
void partial_cholesky(double* front_rows, int pivots, int front, int stride, const double* floor,
                      unsigned char* usable);

}  // namespace framewatch::kernels
