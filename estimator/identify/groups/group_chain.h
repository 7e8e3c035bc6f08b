#pragma once

#include <vector>

#include "estimator/identify/groups/group_equations.h"
#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// Forms the rows of a building's groups instant by instant from the measured coordinates' filtered
/// motion: inner floors simulated from their measured ends, derivatives by every parameter, then
/// each row's oscillator section.
class GroupChain {
 public:
  /// Takes its sizes from `equations`, which must outlive the chain, and starts at rest.
  void start(const GroupEquations& equations, int unknowns);

  /// motion: AxisMotion::kSignals values per measured coordinate. sections: gain, a1, a2 and beta
  /// of the rows. out: rows x padded(unknowns + 1), [h, z].
  void step(const double* motion, const FloorRows& sections, double* out);

  /// The state; what start() has sized.
  template <typename Archive>
  void archive(Archive& a) {
    for (Inner& inner : inner_) a.finite(inner.state, inner.forces_before, inner.derivatives);
    a.finite(s1_, s2_);
  }

 private:
  struct Inner {
    std::vector<double> state, forces_before, forces_now, next;
    /// Of all derivatives, one a column: states, forces before, forces now.
    std::vector<double> derivatives, derivatives_next;
    std::vector<double> on_rows;                 ///< rows x columns
    std::vector<double> with_value, with_first;  ///< [modes; ends]
    std::vector<double> column;
    int columns = 0;
  };
  void add_static(const double* motion);
  void advance(const InnerChain& chain, Inner& inner, const double* motion);
  void derive(const InnerChain& chain, Inner& inner);

  const GroupEquations* equations_ = nullptr;
  int unknowns_ = 0, stride_ = 0;
  std::vector<Inner> inner_;
  std::vector<double> signal_;    ///< rows x stride: derivatives, before the sections
  std::vector<double> response_;  ///< of every row
  std::vector<double> s1_, s2_;
};

}  // namespace framewatch::estimator
