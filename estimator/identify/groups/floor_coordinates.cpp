// SPDX-License-Identifier: MIT
#include "estimator/identify/groups/floor_coordinates.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

/// A reading is independent if at least this relative share of it is not a sum of other readings.
constexpr double kIndependent = 1e-3;

std::vector<int> axes_at(const std::vector<SensorAxis>& axes,
                         const std::vector<std::uint8_t>& present, int story) {
  std::vector<int> at;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].story == story && axes[a].horizontal() && present[a] != 0)
      at.push_back(static_cast<int>(a));
  return at;
}

/// Returns the rows of `seen` that are linearly independent, in their order.
std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& seen) {
  std::vector<Eigen::Index> rows;
  Eigen::MatrixXd basis(seen.cols(), 0);
  for (Eigen::Index r = 0; r < seen.rows() && basis.cols() < seen.cols(); ++r) {
    Eigen::VectorXd rest = seen.row(r).transpose();
    for (Eigen::Index b = 0; b < basis.cols(); ++b) rest -= basis.col(b) * basis.col(b).dot(rest);
    if (rest.norm() <= kIndependent * seen.row(r).norm()) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = rest.normalized();
    rows.push_back(r);
  }
  return rows;
}

/// Returns the least-squares weights of the axes, coordinates x all axes. seen: axes at the place x
/// coordinates.
Eigen::MatrixXd weights(const Eigen::MatrixXd& seen, const std::vector<int>& at,
                        std::size_t all_axes) {
  const Eigen::MatrixXd inverse =
      Cholesky(seen.transpose() * seen).solve(Eigen::MatrixXd(seen.transpose()));
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(seen.cols(), static_cast<Eigen::Index>(all_axes));
  for (std::size_t i = 0; i < at.size(); ++i)
    out.col(at[i]) = inverse.col(static_cast<Eigen::Index>(i));
  return out;
}

/// Returns the motion of the frames for every independent motion of the floor, with a diagonal mass
/// matrix.
Eigen::MatrixXd own_motions(const Structure& s, int story) {
  if (s.floor == FloorModel::flexible) return Eigen::MatrixXd::Identity(s.frames(), s.frames());
  const Eigen::MatrixXd all = floor_constraint(s).middleRows(s.dof(story, 0), s.frames());
  Eigen::MatrixXd out(s.frames(), 0);
  for (Eigen::Index c = 0; c < all.cols(); ++c) {
    if (all.col(c).isZero(0)) continue;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.rightCols(1) = all.col(c);
  }
  return out;
}

}  // namespace

FloorCoordinates floor_coordinates(const Structure& s, const std::vector<SensorAxis>& axes,
                                   const std::vector<std::uint8_t>& present, int story) {
  FloorCoordinates out;
  const Eigen::MatrixXd motions = own_motions(s, story);
  const std::vector<int> at = axes_at(axes, present, story);
  out.from_axes = Eigen::MatrixXd::Zero(0, static_cast<Eigen::Index>(axes.size()));
  out.frames = motions;
  if (at.empty()) return out;
  Eigen::MatrixXd seen(static_cast<Eigen::Index>(at.size()), motions.cols());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::vector<double> w = frame_weights(s, axes[static_cast<std::size_t>(at[i])]);
    seen.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVectorXd>(w.data(), s.frames()) * motions;
  }
  const std::vector<Eigen::Index> rows = independent_rows(seen);
  out.measured = static_cast<int>(rows.size());
  if (out.measured == motions.cols()) {
    out.from_axes = weights(seen, at, axes.size());
    return out;
  }
  Eigen::VectorXd mass(s.frames());
  for (int f = 0; f < s.frames(); ++f) mass[f] = s.frame_mass(story, f);
  const Eigen::MatrixXd m = motions.transpose() * mass.asDiagonal() * motions;
  const Eigen::MatrixXd read = seen(rows, Eigen::all);
  const Eigen::MatrixXd carried = solve_lu(m, Eigen::MatrixXd(read.transpose()));
  const Eigen::MatrixXd basis = orthogonal_basis(read.transpose());
  Eigen::MatrixXd change(motions.cols(), motions.cols());
  change.leftCols(out.measured) = carried * inverse(read * carried);
  change.rightCols(motions.cols() - out.measured) = basis.rightCols(motions.cols() - out.measured);
  out.frames = motions * change;
  out.from_axes = weights(seen * change.leftCols(out.measured), at, axes.size());
  return out;
}

std::array<Eigen::RowVectorXd, 2> base_rotations(const std::vector<SensorAxis>& axes,
                                                 const std::vector<std::uint8_t>& present) {
  std::vector<Eigen::Index> at;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].vertical && axes[a].plan && present[a] != 0)
      at.push_back(static_cast<Eigen::Index>(a));
  const auto count = static_cast<Eigen::Index>(at.size());
  // The lift of each axis by a unit rotation, minus the mean lift, because the base also moves up
  // as a whole.
  Eigen::MatrixXd lifted(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PlanPlace& place = *axes[static_cast<std::size_t>(at[static_cast<std::size_t>(i)])].plan;
    lifted.row(i) << -place.x_m, -place.y_m;
  }
  if (count > 0) lifted.rowwise() -= lifted.colwise().mean().eval();
  const Eigen::Vector2d reach = lifted.colwise().norm();
  std::vector<Eigen::Index> shown;
  for (const Eigen::Index d : {0, 1})
    if (reach[d] > kIndependent * reach.maxCoeff()) shown.push_back(d);
  std::array<Eigen::RowVectorXd, 2> out;
  if (shown.empty()) return out;
  const Eigen::MatrixXd own = lifted(Eigen::all, shown);
  if (independent_rows(own.transpose()).size() < shown.size()) return out;  // a line across both
  const Eigen::MatrixXd plane = weights(own, std::vector<int>(at.begin(), at.end()), axes.size());
  for (std::size_t i = 0; i < shown.size(); ++i)
    out[static_cast<std::size_t>(shown[i])] = plane.row(static_cast<Eigen::Index>(i));
  return out;
}

FloorCoordinates base_coordinates(const Structure& s, const std::vector<SensorAxis>& axes,
                                  const std::vector<std::uint8_t>& present) {
  const double middle_y = s.n() > 0 ? line_position(s, s.n() - 1) / 2 : 0;
  const double middle_x = s.m() > 0 ? line_position(s, s.frames() - 1) / 2 : 0;
  const auto motion = [&](double angle, double x, double y) {
    return Eigen::RowVector3d(std::cos(angle), std::sin(angle),
                              -std::cos(angle) * (y - middle_y) + std::sin(angle) * (x - middle_x));
  };
  const auto of_frame = [&](int f) {
    const double at = line_position(s, f);
    return s.direction(f) == Direction::x ? motion(0, middle_x, at)
                                          : motion(M_PI / 2, at, middle_y);
  };
  const std::vector<int> at = axes_at(axes, present, 0);
  Eigen::MatrixXd seen(static_cast<Eigen::Index>(at.size()), 3);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const SensorAxis& a = axes[static_cast<std::size_t>(at[i])];
    seen.row(static_cast<Eigen::Index>(i)) =
        a.frame >= 0 ? of_frame(a.frame)
        : a.plan     ? motion(a.plan->angle_rad, a.plan->x_m, a.plan->y_m)
                     : motion(a.direction == Direction::x ? 0 : M_PI / 2, middle_x, middle_y);
  }
  Eigen::MatrixXd frames(s.frames(), 3);
  for (int f = 0; f < s.frames(); ++f) frames.row(f) = of_frame(f);
  // A translation that no axis shows is taken as zero. A rotation counts if it is independent of
  // both translations.
  std::vector<Eigen::Index> shown;
  for (const Eigen::Index c : {0, 1})
    if ((c == 0 ? s.n() : s.m()) > 0 && at.size() > 0 &&
        seen.col(c).cwiseAbs().maxCoeff() > kIndependent)
      shown.push_back(c);
  std::vector<Eigen::Index> turning = shown;
  turning.push_back(2);
  const double reach = std::max(middle_x, middle_y);
  Eigen::MatrixXd scaled = seen(Eigen::all, turning);
  if (reach > 0) scaled.rightCols(1) /= reach;
  if (!shown.empty() && reach > 0 && independent_rows(scaled).size() == turning.size())
    shown = turning;
  FloorCoordinates out;
  out.measured = static_cast<int>(shown.size());
  out.frames = frames(Eigen::all, shown);
  out.from_axes = shown.empty() ? Eigen::MatrixXd::Zero(0, static_cast<Eigen::Index>(axes.size()))
                                : weights(seen(Eigen::all, shown), at, axes.size());
  return out;
}

}  // namespace framewatch::estimator
