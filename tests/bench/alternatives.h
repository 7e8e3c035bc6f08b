// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace framewatch::bench {

/// The coefficients of one instant's equations. Equation i has coefficient b for element e's
/// stiffness (times the deformation) and for its damping (times the rate).
struct Pattern {
  int equations;
  int elements;
  int entries;
  const int* equation;
  const int* element;
  const double* coefficient;
};

/// Another solution of the same window's least-squares problem, with Eigen's dense algebra. Its
/// input is filtered motion, which is not timed: per instant the elements' deformations, their
/// rates and the equations' right-hand sides. Compiled for one instruction set, in a separate
/// shared library. Only raw pointers cross its interface, because Eigen's types differ between
/// instruction sets.
class Alternative {
 public:
  virtual ~Alternative() = default;
  /// motion: instants x (2 elements + equations), the whole window. Uses the last `counted`
  /// instants.
  virtual void solve(const double* motion, int instants, int counted) = 0;
  virtual const double* solution() const = 0;
};

enum class Method {
  naive,          ///< rebuilds every window: dense rows, their Gram matrix, LLT
  recursive_llt,  ///< keeps the Gram matrix: adds the newest instant, subtracts the oldest, LLT
  recursive_ldlt  ///< the same with Eigen's pivoting LDLT
};

/// Null if the machine lacks the instruction set. The sets are the one of every x86-64, as the
/// program itself uses, AVX2 and AVX-512.
std::unique_ptr<Alternative> make_alternative_v1(Method method, const Pattern& pattern);
std::unique_ptr<Alternative> make_alternative_v3(Method method, const Pattern& pattern);
std::unique_ptr<Alternative> make_alternative_v4(Method method, const Pattern& pattern);

}  // namespace framewatch::bench
