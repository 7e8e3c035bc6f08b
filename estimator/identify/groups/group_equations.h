#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/identify/groups/reduced_building.h"
#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// What of the rows is linear in the measured motion alone: of one parameter, or of none.
struct StaticPart {
  int parameter;
  bool damping;  ///< of p', else of p
  std::vector<int> rows, columns;
  std::vector<double> matrix;  ///< columns x rows: by columns
};

/// One parameter's forces on an inner set's modes and on the rows, of [modes; ends]: displacements
/// of a stiffness, rates of a damping. By columns.
struct InnerForce {
  int parameter;
  bool damping;
  std::vector<double> on_modes;  ///< (modes + ends) x modes
  std::vector<double> on_rows;   ///< modes x rows
};

/// The motion of an inner set between its measured ends, in modes with the ends held, as a
/// recursion that is exact for forces linear between instants:
///   state' = transition [state; forces before; forces now],
/// state: the modes' displacements times kScale_radps, then their rates.
struct InnerChain {
  static constexpr double kScale_radps = 60;
  int modes = 0;
  std::vector<int> ends;  ///< measured coordinates
  std::vector<int> rows;
  std::vector<double> transition;               ///< 2 modes x 4 modes, row-major
  std::vector<double> transition_columns;       ///< the same by columns
  std::vector<double> from_first, from_second;  ///< forces by p', p'' of the ends, by columns
  std::vector<double> stiffness;                ///< w^2 of the modes
  std::vector<double> damping;                  ///< modes x modes, by columns
  std::vector<double> inertia;                  ///< rows by modal accelerations, by columns
  std::vector<double> friction;                 ///< rows by modal rates, by columns
  std::vector<double> read_out;  ///< rows x 3 modes, row-major: of [state; forces] of a derivative
  std::vector<InnerForce> forces;
  Eigen::MatrixXd frames;       ///< motion of the frames by the modes, ReducedBuilding::frames
  double slowest_radps = 0;     ///< least decay of its modes
  std::vector<PolePair> poles;  ///< of the recursion: its natural responses
};

/// The equations of motion of the measured floors for parameters x times the design: residual rows
/// r = P That' (s^2 M + s C + K) That a_B with the inner floors driven by the measured ones, and
/// their derivatives, projected on each floor's own modes. docs/equations.md, groups of stories;
/// source: Koh, See and Balendra, Earthq. Eng. Struct. Dyn. 20 (1991), 1169.
struct GroupEquations {
  int rows = 0;
  std::vector<double> frequency_hz;               ///< of each row: of its floor, neighbours held
  std::vector<StaticPart> parts;                  ///< by x: derivative times x
  Eigen::MatrixXd by_value, by_first, by_second;  ///< rows x measured: of no parameter
  Eigen::MatrixXd projection;                     ///< rows by the measured floors' equations
  Eigen::MatrixXd frames;  ///< motion of the frames by the measured coordinates, static
  std::vector<InnerChain> chains;
};

/// How many modes of inner floors are kept: as many as the estimation needs, or, where nothing but
/// their motion is wanted, all that the derivative filters reach.
enum class InnerModes { few, all_below_20_hz };

/// x: factor of every parameter; those that stand for others count.
GroupEquations group_equations(const ReducedBuilding& building, const Eigen::VectorXd& x,
                               double rate_hz, InnerModes modes = InnerModes::few);

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
