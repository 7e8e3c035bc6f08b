// SPDX-License-Identifier: MIT
#include "estimator/gap/measured_inputs.h"

#include <algorithm>
#include <array>
#include <cmath>

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

DrivingAxes::DrivingAxes(const std::vector<SensorAxis>& axes, double rate_hz)
    : axes_(axes),
      all_(identifying(axes)),
      present_(all_),
      seen_(all_),
      enough_instants_(static_cast<int>(std::ceil(kSteady_s * rate_hz))) {}

bool DrivingAxes::drives(std::size_t axis) const {
  return all_[axis] != 0 && (axes_[axis].story == 0 || axes_[axis].is_force);
}

bool DrivingAxes::push(const std::vector<double>& values) {
  bool same = true;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const std::uint8_t now = !drives(a) || !std::isnan(values[a]) ? all_[a] : 0;
    same = same && now == seen_[a];
    seen_[a] = now;
  }
  steady_ = same ? std::min(steady_ + 1, enough_instants_) : 0;
  if (steady_ < enough_instants_ || seen_ == present_ || !enough(seen_)) return false;
  present_ = seen_;
  return true;
}

bool DrivingAxes::enough(const std::vector<std::uint8_t>& present) const {
  for (std::size_t lost = 0; lost < axes_.size(); ++lost) {
    const SensorAxis& axis = axes_[lost];
    if (present[lost] == all_[lost] || axis.vertical) continue;
    bool replaced = false;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      replaced = replaced || (drives(a) && present[a] != 0 && axes_[a].horizontal() &&
                              axes_[a].direction == axis.direction);
    if (axis.is_force || !replaced) return false;
  }
  return true;
}

bool DrivingAxes::restore(const std::vector<std::uint8_t>& present,
                          const std::vector<std::uint8_t>& seen) {
  for (const auto* flags : {&present, &seen}) {
    if (flags->size() != all_.size()) return false;
    for (std::size_t a = 0; a < all_.size(); ++a)
      if ((*flags)[a] > all_[a] || (!drives(a) && (*flags)[a] != all_[a])) return false;
  }
  if (!enough(present)) return false;
  present_ = present;
  seen_ = seen;
  return true;
}

}  // namespace framewatch::estimator
