// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// Removes from the rows of a regression the effect of the motion before the first sample, which
/// was not measured.
///
/// A filter that starts at rest in full motion forms rows [h, z] that differ from those of a filter
/// that has always run. The difference is a combination of the filter's natural responses: two
/// known functions of time for each pair of poles, here called shapes, s_1(t), s_2(t), ..., with
/// unknown factors. The factors are nuisance unknowns of that equation.
///
/// Every row is replaced by its recursive residual: the part that remains after the shapes have
/// been fitted to this and all earlier rows since the start. The sum of squares of recursive
/// residuals equals the sum of squares with the shapes projected out (Brown, Durbin and Evans, J.
/// R. Stat. Soc. B 37 (1975), 149). So the window's sums of H^T H are unaffected by starts, and a
/// start costs each equation as many rows as it has shapes. docs/equations.md, starting in motion.
///
/// Each shape takes one Givens rotation. The numbers do not depend on mathematical libraries.
class UnknownPast {
 public:
  /// stride: doubles in a row. Allocates for most_rows equations with most_shapes shapes; begin()
  /// and add() allocate only beyond that.
  UnknownPast(int stride, int most_rows, int most_shapes);

  /// Starts anew: the filters of `rows` equations start with the next instant.
  void begin(int rows);
  /// Adds the two shapes of a pole pair to an equation: s[t] = -a1 s[t-1] - a2 s[t-2].
  void add(int row, const PolePair& poles);
  /// Stops removing.
  void end() { equations_ = 0; }

  /// Replaces the rows of one instant, rows x stride. Returns false while the equations have fewer
  /// rows than shapes; such rows must not be used.
  bool remove(double* rows);

  void archive(auto& a) {
    a.within(equations_, 0, kMaxEquations);
    a.within(instants_, 0, a.kMaxCount);
    if (!(equations_ >= 0 && equations_ <= kMaxEquations)) equations_ = 0;
    if (a.kReading)
      if (equation_.size() < static_cast<std::size_t>(equations_))
        equation_.resize(static_cast<std::size_t>(equations_));
    for (std::size_t i = 0; i < static_cast<std::size_t>(equations_); ++i) archive(a, equation_[i]);
  }

 private:
  static constexpr int kMaxEquations = 512;  ///< equations of a floor, more than any building has
  static constexpr int kMaxPoles = 128;  ///< pole pairs of an equation, more than any building has
  struct Equation {
    std::vector<PolePair> poles;
    std::vector<double> now, before;  ///< the shapes at this instant and the one before
    std::vector<double> factor;       ///< shapes x shapes, upper: R of S = Q R
    std::vector<double> fitted;       ///< shapes x stride: Q^T of the rows
    std::vector<double> shape;        ///< buffer of one call
  };
  void archive(auto& a, Equation& e) {
    auto poles = static_cast<int>(e.poles.size());
    a.within(poles, 0, kMaxPoles);
    if (a.kReading) {
      if (!a.good()) return;
      e.poles.resize(static_cast<std::size_t>(poles >= 0 && poles <= kMaxPoles ? poles : 0));
      resize(e);
    }
    for (PolePair& pair : e.poles) a.finite(pair.a1, pair.a2);
    a.finite(e.now, e.before, e.factor, e.fitted);
  }
  void resize(Equation& equation) const;
  static bool step(Equation& equation);
  void rotate(Equation& equation, double* row) const;

  std::size_t stride_;
  int equations_ = 0;  ///< 0: nothing is removed
  int instants_ = 0;   ///< since the start
  std::vector<Equation> equation_;
};

}  // namespace framewatch::estimator
