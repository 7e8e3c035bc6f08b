#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// A spring with at least one coordinate in an inner set.
struct InnerSpring {
  std::vector<std::pair<int, double>> deformation;  ///< in the set: coordinate, coefficient
  std::vector<std::pair<int, double>> ends;         ///< in measured coordinates
  double stiffness;
  bool hinge;  ///< rotational: its stiffness may differ from the design by much
};

/// Coordinates that are not measured and move together.
struct InnerSet {
  Eigen::MatrixXd mass;
  std::vector<InnerSpring> springs;
};

/// A set of at most so many coordinates is kept as it is.
inline constexpr int kMaxInner = 40;

/// Shapes, orthonormal columns, whose sums are the set's motions: all of them, or the lowest modes
/// with the ends held and the static shapes under motion of the ends, for hinges as designed, a
/// third and three times as stiff. measured: number of measured coordinates.
Eigen::MatrixXd inner_shapes(const InnerSet& set, int measured);

}  // namespace framewatch::estimator
