#include "estimator/gap/measured_inputs.h"

#include <array>

#include "estimator/identify/groups/floor_coordinates.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

void add(MeasuredInputs& to, const Eigen::RowVectorXd& from_axes, const Eigen::VectorXd& influence,
         const Eigen::VectorXd& force) {
  const auto grow = [](Eigen::MatrixXd& m, const Eigen::VectorXd& column) {
    m.conservativeResize(Eigen::NoChange, m.cols() + 1);
    m.rightCols(1) = column;
  };
  grow(to.inputs.influence, influence);
  grow(to.inputs.force, force);
  to.from_axes.conservativeResize(to.from_axes.rows() + 1, Eigen::NoChange);
  to.from_axes.bottomRows(1) = from_axes;
}

}  // namespace

MeasuredInputs measured_inputs(const Structure& s, const std::vector<SensorAxis>& axes,
                               const std::vector<std::uint8_t>& present) {
  const int dofs = s.degrees_of_freedom();
  const auto count = static_cast<Eigen::Index>(axes.size());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(dofs);
  MeasuredInputs out;
  out.inputs.influence.resize(dofs, 0);
  out.inputs.force.resize(dofs, 0);
  out.from_axes.resize(0, count);

  const FloorCoordinates base = base_coordinates(s, axes, present);
  for (Eigen::Index i = 0; i < base.measured; ++i)
    add(out, base.from_axes.row(i), base.frames.col(i).replicate(s.stories, 1), none);
  const std::array<Eigen::RowVectorXd, 2> rocking = base_rotations(axes, present);
  for (const Direction along : {Direction::x, Direction::y}) {
    const Eigen::RowVectorXd& turned = rocking[along == Direction::x ? 0 : 1];
    if (turned.size() == 0) continue;
    Eigen::VectorXd lever = none;
    double height = 0;
    for (int story = 1; story <= s.stories; ++story) {
      height += s.story_height[static_cast<std::size_t>(story - 1)];
      for (int f = 0; f < s.frames(); ++f)
        if (s.direction(f) == along) lever[s.dof(story, f)] = height;
    }
    add(out, turned, lever, none);
  }
  for (Eigen::Index a = 0; a < count; ++a) {
    const SensorAxis& axis = axes[static_cast<std::size_t>(a)];
    if (!axis.is_force || present[static_cast<std::size_t>(a)] == 0) continue;
    const std::vector<double> weights = frame_weights(s, axis);
    Eigen::VectorXd force = none;
    for (int f = 0; f < s.frames(); ++f)
      force[s.dof(axis.story, f)] = weights[static_cast<std::size_t>(f)];
    add(out, Eigen::RowVectorXd::Unit(count, a), none, force);
  }
  for (Eigen::Index a = 0; a < count; ++a)
    if (!out.from_axes.col(a).isZero(0)) out.used.push_back(a);
  return out;
}

}  // namespace framewatch::estimator
