// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace framewatch::bench {

/// How the equations of one instant see the elements: equation i has coefficient b of element e for
/// the stiffness (times the deformation) and for the damping (times its rate).
struct Pattern {
  int equations;
  int elements;
  int entries;
  const int* equation;
  const int* element;
  const double* coefficient;
};

/// Another way to the same window's least-squares solution, by Eigen's dense algebra. Its input is
/// filtered motion, for free: per instant the elements' deformations, their rates and the
/// equations' right-hand sides. Compiled for one instruction set, in a shared library of its own:
/// only raw pointers cross, because Eigen's types differ between instruction sets.
class Alternative {
 public:
  virtual ~Alternative() = default;
  /// motion: instants x (2 elements + equations), the window. Works on the last `counted` instants.
  virtual void solve(const double* motion, int instants, int counted) = 0;
  virtual const double* solution() const = 0;
};

enum class Method {
  naive,          ///< every window anew: dense rows, their Gram matrix, LLT
  recursive_llt,  ///< Gram matrix kept: newest instant added, oldest subtracted, LLT
  recursive_ldlt  ///< the same with Eigen's pivoting LDLT
};

/// Null when the machine has not the instruction set: what every x86-64 has, as the program itself
/// is built; AVX2; AVX-512.
std::unique_ptr<Alternative> make_alternative_v1(Method method, const Pattern& pattern);
std::unique_ptr<Alternative> make_alternative_v3(Method method, const Pattern& pattern);
std::unique_ptr<Alternative> make_alternative_v4(Method method, const Pattern& pattern);

}  // namespace framewatch::bench
