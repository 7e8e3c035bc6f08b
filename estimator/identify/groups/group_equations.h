// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/identify/groups/reduced_building.h"
#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// The part of the rows that is linear in the measured motion alone, for one parameter or without
/// parameter.
struct StaticPart {
  int parameter;
  bool damping;  ///< acts on p', otherwise on p
  std::vector<int> rows, columns;
  std::vector<double> matrix;  ///< columns x rows, stored by columns
};

/// The forces of one parameter on an inner set's modes and on the rows. They act on displacements
/// of [modes; ends] for a stiffness and on rates for a damping. Matrices are stored by columns.
struct InnerForce {
  int parameter;
  bool damping;
  std::vector<double> on_modes;  ///< (modes + ends) x modes
  std::vector<double> on_rows;   ///< modes x rows
};

/// The motion of an inner set between its measured ends, in modes with the ends held. It is a
/// recursion that is exact for forces linear between instants:
///   state' = transition [state; forces before; forces now].
/// The state holds the modes' displacements times kScale_radps, then their rates.
struct InnerChain {
  static constexpr double kScale_radps = 60;
  int modes = 0;
  std::vector<int> ends;  ///< measured coordinates
  std::vector<int> rows;
  std::vector<double> transition;               ///< 2 modes x 4 modes, row-major
  std::vector<double> transition_columns;       ///< the same matrix by columns
  std::vector<double> from_first, from_second;  ///< forces of p', p'' of the ends, by columns
  std::vector<double> stiffness;                ///< w^2 of the modes
  std::vector<double> damping;                  ///< modes x modes, by columns
  std::vector<double> inertia;                  ///< rows by modal accelerations, stored by columns
  std::vector<double> friction;                 ///< rows by modal rates, stored by columns
  std::vector<double> read_out;  ///< rows x 3 modes, row-major: for [state; forces] of a derivative
  std::vector<InnerForce> forces;
  Eigen::MatrixXd frames;       ///< frames by modes, ReducedBuilding::frames
  double slowest_radps = 0;     ///< slowest decay of the modes
  std::vector<PolePair> poles;  ///< natural responses of the recursion
};

/// The equations of motion of the measured floors, for parameters x times the design: the residual
/// rows r = P That' (s^2 M + s C + K) That a_B with the inner floors driven by the measured ones,
/// and their derivatives. Rows are projected on each floor's own modes.
/// docs/equations.md, groups of stories; source: Koh, See and Balendra, Earthq. Eng. Struct. Dyn.
/// 20 (1991), 1169.
struct GroupEquations {
  int rows = 0;
  std::vector<double> frequency_hz;               ///< by row: of its floor with neighbors held
  std::vector<StaticPart> parts;                  ///< by x: derivative times x
  Eigen::MatrixXd by_value, by_first, by_second;  ///< rows x measured, without parameter
  Eigen::MatrixXd projection;                     ///< rows x equations of measured floors
  Eigen::MatrixXd frames;  ///< static motion of the frames by the measured coordinates
  std::vector<InnerChain> chains;
};

/// The modes of inner floors to keep: few, as the estimation needs, or all that the derivative
/// filters reach, if only the floors' motion is computed.
enum class InnerModes { few, all_below_20_hz };

/// Returns the equations. x: factor of every parameter; the factor of a merged group's first
/// parameter holds for all of it.
GroupEquations group_equations(const ReducedBuilding& building, const Eigen::VectorXd& x,
                               double rate_hz, InnerModes modes = InnerModes::few);

/// Forms the rows of a building in groups, instant by instant, from the filtered motion of the
/// measured coordinates. It simulates inner floors from their measured ends, takes derivatives by
/// every parameter, then applies each row's oscillator section.
class GroupChain {
 public:
  /// Takes the sizes of `equations`, which must outlive the chain, and starts at rest.
  void start(const GroupEquations& equations, int unknowns);

  /// Advances by one instant. motion: AxisMotion::kSignals values per measured coordinate.
  /// sections: gain, a1, a2 and beta of the rows. out: rows x padded(unknowns + 1), [h, z].
  void step(const double* motion, const FloorRows& sections, double* out);

  /// Archives the state. Call start() before reading, because it sets the sizes.
  void archive(auto& a) {
    for (Inner& inner : inner_) a.finite(inner.state, inner.forces_before, inner.derivatives);
    a.finite(s1_, s2_);
  }

 private:
  struct Inner {
    std::vector<double> state, forces_before, forces_now, next;
    /// Derivatives, one per column: states, forces before, forces now.
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
  std::vector<double> signal_;    ///< rows x stride: derivatives before the sections
  std::vector<double> response_;  ///< by row
  std::vector<double> s1_, s2_;
};

}  // namespace framewatch::estimator
