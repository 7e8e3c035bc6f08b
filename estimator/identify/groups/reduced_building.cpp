// SPDX-License-Identifier: MIT
#include "estimator/identify/groups/reduced_building.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "estimator/identify/groups/floor_coordinates.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

/// A spring with at least one coordinate in an inner set.
struct InnerSpring {
  std::vector<std::pair<int, double>> deformation;  ///< coordinate of the set, coefficient
  std::vector<std::pair<int, double>> ends;         ///< measured coordinate, coefficient
  double stiffness;
  bool hinge;  ///< rotational; its stiffness may differ much from the design
};

/// Unmeasured coordinates that move together.
struct InnerSet {
  Eigen::MatrixXd mass;
  std::vector<InnerSpring> springs;
};

/// Largest number of coordinates of a set that is not reduced.
constexpr int kMaxInner = 40;

constexpr int kShapes = 24;    // modes of a large set
constexpr double kSpread = 3;  // factor by which the stiffness of hinges may be off
constexpr double kIndependentShape = 1e-7;

Eigen::MatrixXd shapes_of(const InnerSet& set, int measured, double hinge_factor) {
  const Eigen::Index n = set.mass.rows();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd coupling = Eigen::MatrixXd::Zero(n, measured);
  for (const InnerSpring& s : set.springs) {
    const double k = s.stiffness * (s.hinge ? hinge_factor : 1);
    for (const auto& [i, b] : s.deformation) {
      for (const auto& [j, d] : s.deformation) stiffness(i, j) += k * b * d;
      for (const auto& [j, d] : s.ends) coupling(i, j) += k * b * d;
    }
  }
  std::vector<Eigen::Index> moved;
  for (Eigen::Index j = 0; j < measured; ++j)
    if (!coupling.col(j).isZero(0)) moved.push_back(j);
  const RealEigen modes = generalized_eigen(set.mass, stiffness);  // ascending 1 / w^2
  const Eigen::Index kept = std::min<Eigen::Index>(kShapes, n);
  Eigen::MatrixXd out(n, kept + static_cast<Eigen::Index>(moved.size()));
  out.leftCols(kept) = modes.vectors.rightCols(kept);
  const Eigen::MatrixXd ends = coupling(Eigen::all, moved);
  out.rightCols(ends.cols()) = Cholesky(stiffness).solve(ends);
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i).normalize();
  return out;
}

/// Returns orthonormal columns whose sums are the motions of the set. A small set keeps all its
/// motions. A large set is described by its lowest modes with the ends held and the static shapes
/// under motion of the ends, for hinges as designed, a third as stiff and three times as stiff.
/// measured: number of measured coordinates.
Eigen::MatrixXd inner_shapes(const InnerSet& set, int measured) {
  const Eigen::Index n = set.mass.rows();
  if (n <= kMaxInner) return Eigen::MatrixXd::Identity(n, n);
  const bool hinges = std::any_of(set.springs.begin(), set.springs.end(),
                                  [](const InnerSpring& s) { return s.hinge; });
  Eigen::MatrixXd all = shapes_of(set, measured, 1);
  for (const double factor : {1 / kSpread, kSpread}) {
    if (!hinges) break;
    const Eigen::MatrixXd more = shapes_of(set, measured, factor);
    all.conservativeResize(Eigen::NoChange, all.cols() + more.cols());
    all.rightCols(more.cols()) = more;
  }
  const SingularValues independent = singular_values(all);
  Eigen::Index kept = 0;
  while (kept < independent.values.size() &&
         independent.values[kept] > kIndependentShape * independent.values[0])
    ++kept;
  return independent.left.leftCols(kept);
}

constexpr double kCoupled = 1e-9;  // share of a mass matrix' diagonal

/// A frame story, floor panel or hinge with stiffness and damping along a deformation.
struct Spring {
  std::vector<std::pair<int, double>> deformation;  ///< coordinate, coefficient
  double stiffness, damping;
  int stiffness_parameter, damping_parameter;  ///< -1: not identified
  bool hinge = false;
};

/// All coordinates, the measured ones first.
struct Coordinates {
  std::vector<FloorCoordinates> floor;  ///< base first
  std::vector<std::vector<int>> index;  ///< coordinates of every floor
  std::vector<int> forces;              ///< axes of the coordinates after the base's
  std::array<Eigen::RowVectorXd, 2> rotation_of_axes;
  std::array<int, 2> rotation{-1, -1};  ///< coordinates after the forces; -1: not known
  int inputs = 0, measured = 0, total = 0;
};

Coordinates number_coordinates(const Structure& s, const std::vector<SensorAxis>& axes,
                               const std::vector<std::uint8_t>& present) {
  Coordinates c;
  c.floor.push_back(base_coordinates(s, axes, present));
  for (int story = 1; story <= s.stories; ++story)
    c.floor.push_back(floor_coordinates(s, axes, present, story));
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].is_force && present[a] != 0) c.forces.push_back(static_cast<int>(a));
  c.inputs = c.floor[0].measured + static_cast<int>(c.forces.size());
  c.rotation_of_axes = base_rotations(axes, present);
  for (std::size_t along = 0; along < c.rotation.size(); ++along)
    if (c.rotation_of_axes[along].size() > 0) c.rotation[along] = c.inputs++;
  c.index.resize(c.floor.size());
  for (const bool inner : {false, true}) {
    for (std::size_t l = 0; l < c.floor.size(); ++l) {
      const auto from = inner ? static_cast<Eigen::Index>(c.floor[l].measured) : 0;
      const auto to =
          inner ? c.floor[l].frames.cols() : static_cast<Eigen::Index>(c.floor[l].measured);
      for (Eigen::Index i = from; i < to; ++i) c.index[l].push_back(c.total++);
      if (l == 0 && !inner) c.total = c.inputs;
    }
    if (!inner) c.measured = c.total;
  }
  return c;
}

void add_motion(const Coordinates& c, std::size_t floor, const Eigen::RowVectorXd& of_floor,
                double factor, Spring& spring) {
  for (Eigen::Index i = 0; i < of_floor.size(); ++i)
    if (of_floor[i] != 0)
      spring.deformation.emplace_back(c.index[floor][static_cast<std::size_t>(i)],
                                      factor * of_floor[i]);
}

std::vector<Spring> springs(const Structure& s, const ParameterTable& table,
                            const GroupDesign& design, Coordinates& c) {
  const ParameterTable stories(s);
  std::vector<Spring> out;
  const int hinges = c.total;
  std::vector<int> first_hinge(static_cast<std::size_t>(s.frames()), -1);
  c.total = hinges;
  for (int f = 0; f < s.frames(); ++f) {
    const std::size_t along = s.direction(f) == Direction::x ? 0 : 1;
    if (!(design.bending_nmprad[along] > 0)) continue;
    first_hinge[static_cast<std::size_t>(f)] = c.total;
    const int parameter = table.find(along == 0 ? "krx" : "kry").value_or(-1);
    for (std::size_t j = 0; j < static_cast<std::size_t>(s.stories); ++j)
      out.push_back(
          {{{c.total++, 1.0}}, design.bending_nmprad.of_floor(along, j), 0, parameter, -1, true});
  }
  for (const Element& e : elements(s, stories)) {
    const auto floor = static_cast<std::size_t>(e.story);
    Spring spring{
        {}, design.theta[e.stiffness], design.theta[e.stiffness + stories.elements()], -1, -1};
    if (e.frame >= 0) {
      add_motion(c, floor, c.floor[floor].frames.row(e.frame), 1, spring);
      add_motion(c, floor - 1, c.floor[floor - 1].frames.row(e.frame), -1, spring);
      const double height = s.story_height[floor - 1];
      const int rocking = c.rotation[s.direction(e.frame) == Direction::x ? 0 : 1];
      if (rocking >= 0) spring.deformation.emplace_back(rocking, -height);
      const int hinge = first_hinge[static_cast<std::size_t>(e.frame)];
      for (int j = 0; hinge >= 0 && j < e.story; ++j)
        spring.deformation.emplace_back(hinge + j, -height);
      spring.stiffness_parameter = table.frame_stiffness(e.story, e.frame);
      if (spring.stiffness_parameter >= 0)
        spring.damping_parameter = spring.stiffness_parameter + table.elements();
    } else {
      Eigen::RowVectorXd motion = Eigen::RowVectorXd::Zero(s.frames());
      for (const auto& [dof, b] : e.b) motion[dof - s.dof(e.story, 0)] = b;
      add_motion(c, floor, motion * c.floor[floor].frames, 1, spring);
    }
    out.push_back(std::move(spring));
  }
  return out;
}

/// Returns the sets of inner coordinates that springs or masses connect, each ascending.
std::vector<std::vector<int>> connected(const std::vector<Spring>& springs,
                                        const Eigen::MatrixXd& mass, const Coordinates& c) {
  std::vector<int> root(static_cast<std::size_t>(c.total));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)];
    return i;
  };
  for (const Spring& spring : springs) {
    int first = -1;
    for (const auto& [i, b] : spring.deformation) {
      if (i < c.measured) continue;
      if (first < 0)
        first = find(i);
      else
        root[static_cast<std::size_t>(find(i))] = find(first);
    }
  }
  for (const std::vector<int>& of_floor : c.index)
    for (const int i : of_floor)
      for (const int j : of_floor)
        if (i >= c.measured && j >= c.measured && std::abs(mass(i, j)) > kCoupled * mass(i, i))
          root[static_cast<std::size_t>(find(i))] = find(j);
  std::vector<std::vector<int>> by_root(static_cast<std::size_t>(c.total)), out;
  for (int i = c.measured; i < c.total; ++i)
    by_root[static_cast<std::size_t>(find(i))].push_back(i);
  for (std::vector<int>& set : by_root)
    if (!set.empty()) out.push_back(std::move(set));
  return out;
}

/// Adds the forces, which do work on the motion of their places.
void add_forces(const Structure& s, const std::vector<SensorAxis>& axes, const Coordinates& c,
                Eigen::MatrixXd& mass) {
  for (std::size_t n = 0; n < c.forces.size(); ++n) {
    const SensorAxis& force = axes[static_cast<std::size_t>(c.forces[n])];
    const auto l = static_cast<std::size_t>(force.story);
    const std::vector<double> weights = frame_weights(s, force);
    const Eigen::RowVectorXd lever =
        Eigen::Map<const Eigen::RowVectorXd>(weights.data(), s.frames()) * c.floor[l].frames;
    const int at = c.floor[0].measured + static_cast<int>(n);
    for (Eigen::Index i = 0; i < lever.size(); ++i)
      mass(at, c.index[l][static_cast<std::size_t>(i)]) =
          mass(c.index[l][static_cast<std::size_t>(i)], at) = -lever[i];
  }
}

Eigen::MatrixXd mass_of(const Structure& s, const std::vector<SensorAxis>& axes,
                        const Coordinates& c) {
  const Eigen::VectorXd masses = frame_masses(s);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(c.total, c.total);
  for (int story = 1; story <= s.stories; ++story) {
    const auto l = static_cast<std::size_t>(story);
    const Eigen::VectorXd frames = masses.segment(s.dof(story, 0), s.frames());
    const Eigen::MatrixXd& motion = c.floor[l].frames;
    const Eigen::MatrixXd m = motion.transpose() * frames.asDiagonal() * motion;
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j)
        mass(c.index[l][static_cast<std::size_t>(i)], c.index[l][static_cast<std::size_t>(j)]) =
            m(i, j);
  }
  add_forces(s, axes, c, mass);
  return mass;
}

/// Returns the motion of the frames at the base and at every floor by all coordinates.
Eigen::MatrixXd frames_of(const Structure& s, const Coordinates& c) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero((s.stories + 1) * s.frames(), c.total);
  for (std::size_t l = 0; l < c.floor.size(); ++l)
    for (std::size_t i = 0; i < c.index[l].size(); ++i)
      out.col(c.index[l][i]).segment(static_cast<Eigen::Index>(l) * s.frames(), s.frames()) =
          c.floor[l].frames.col(static_cast<Eigen::Index>(i));
  return out;
}

/// Motion of all coordinates (rows) by the measured ones and by those that describe inner sets
/// (columns).
struct Basis {
  Eigen::MatrixXd shapes;
  std::vector<int> sets;
};

Basis basis_of(const std::vector<Spring>& springs, const Eigen::MatrixXd& mass,
               const Coordinates& c) {
  Basis out;
  std::vector<Eigen::MatrixXd> inner;
  const std::vector<std::vector<int>> sets = connected(springs, mass, c);
  int columns = c.measured;
  for (const std::vector<int>& set : sets) {
    out.sets.push_back(columns);
    std::vector<int> place(static_cast<std::size_t>(c.total), -1);
    for (std::size_t i = 0; i < set.size(); ++i)
      place[static_cast<std::size_t>(set[i])] = static_cast<int>(i);
    InnerSet described{Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(set.size()),
                                             static_cast<Eigen::Index>(set.size())),
                       {}};
    for (std::size_t i = 0; i < set.size(); ++i)
      for (std::size_t j = 0; j < set.size(); ++j)
        described.mass(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            mass(set[i], set[j]);
    for (const Spring& spring : springs) {
      InnerSpring inside{{}, {}, spring.stiffness, spring.hinge};
      for (const auto& [i, b] : spring.deformation) {
        if (i < c.measured)
          inside.ends.emplace_back(i, b);
        else if (const int at = place[static_cast<std::size_t>(i)]; at >= 0)
          inside.deformation.emplace_back(at, b);
      }
      if (!inside.deformation.empty()) described.springs.push_back(std::move(inside));
    }
    inner.push_back(inner_shapes(described, c.measured));
    columns += static_cast<int>(inner.back().cols());
  }
  out.sets.push_back(columns);
  out.shapes = Eigen::MatrixXd::Zero(c.total, columns);
  for (int i = 0; i < c.measured; ++i) out.shapes(i, i) = 1;
  for (std::size_t n = 0; n < sets.size(); ++n)
    for (std::size_t i = 0; i < sets[n].size(); ++i)
      out.shapes.row(sets[n][i]).segment(out.sets[n], inner[n].cols()) =
          inner[n].row(static_cast<Eigen::Index>(i));
  return out;
}

/// Returns by parameter the first one of the group that it belongs to if only these axes are
/// present.
std::vector<int> first_of_group(const Structure& s, const std::vector<SensorAxis>& axes,
                                const ParameterTable& table,
                                const std::vector<std::uint8_t>& present) {
  std::vector<SensorAxis> there;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (present[a] != 0) there.push_back(axes[a]);
  const std::vector<StoryGroup> groups = story_groups(s, there).groups;
  std::vector<int> same(static_cast<std::size_t>(table.size()));
  std::iota(same.begin(), same.end(), 0);
  for (int p = 0; p < table.size(); ++p) {
    if (table[p].kind == ParameterKind::bending_stiffness) continue;
    for (const StoryGroup& group : groups) {
      const auto holds = [&](const Parameter& q) {
        return q.kind == table[p].kind && q.story >= group.first && q.last_story <= group.last &&
               !q.frames.empty() &&
               std::find(group.frames.begin(), group.frames.end(), q.frames[0]) !=
                   group.frames.end();
      };
      if (!holds(table[p])) continue;
      for (int q = 0; q < p && same[static_cast<std::size_t>(p)] == p; ++q)
        if (holds(table[q])) same[static_cast<std::size_t>(p)] = q;
    }
  }
  return same;
}

}  // namespace

ReducedBuilding reduced_building(const Structure& s, const std::vector<SensorAxis>& axes,
                                 const ParameterTable& table, const GroupDesign& design,
                                 const std::vector<std::uint8_t>& present, bool keep_groups) {
  Coordinates c = number_coordinates(s, axes, present);
  const std::vector<Spring> all = springs(s, table, design, c);
  const Eigen::MatrixXd mass = mass_of(s, axes, c);
  const Basis basis = basis_of(all, mass, c);
  ReducedBuilding out;
  out.inputs = c.inputs;
  out.measured = c.measured;
  out.sets = basis.sets;
  out.from_axes.resize(c.measured, static_cast<Eigen::Index>(axes.size()));
  int row = 0;
  for (std::size_t l = 0; l < c.floor.size(); ++l) {
    if (l > 0 && c.floor[l].measured > 0) out.floors.push_back(row);
    out.from_axes.middleRows(row, c.floor[l].measured) = c.floor[l].from_axes;
    row += c.floor[l].measured;
    if (l > 0) continue;
    out.from_axes.middleRows(row, c.inputs - row).setZero();
    for (const int axis : c.forces) out.from_axes(row++, axis) = 1;
    for (const Eigen::RowVectorXd& of_axes : c.rotation_of_axes) {
      if (of_axes.size() == 0) continue;
      out.from_axes.row(row++) = of_axes;
      ++out.rotations;
    }
  }
  out.floors.push_back(row);
  const Eigen::Index size = basis.shapes.cols();
  out.mass = basis.shapes.transpose() * mass * basis.shapes;
  out.constant_stiffness = out.constant_damping = Eigen::MatrixXd::Zero(size, size);
  out.parts.assign(static_cast<std::size_t>(table.size()), Eigen::MatrixXd::Zero(size, size));
  for (int p = 0; p < table.size(); ++p)
    out.damping.push_back(table[p].kind == ParameterKind::frame_damping ? 1 : 0);
  out.frames = frames_of(s, c) * basis.shapes;
  out.same_as.resize(static_cast<std::size_t>(table.size()));
  std::iota(out.same_as.begin(), out.same_as.end(), 0);
  if (!keep_groups) out.same_as = first_of_group(s, axes, table, present);
  if (!shows_groups(s, axes, present)) {
    out.measured = out.inputs;
    out.floors = {out.inputs};
    return out;
  }
  for (const Spring& spring : all) {
    Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
    for (const auto& [i, factor] : spring.deformation)
      b += factor * basis.shapes.row(i).transpose();
    const auto add = [&](int parameter, double value, Eigen::MatrixXd& constant) {
      if (value == 0) return;
      Eigen::MatrixXd& to = parameter < 0 ? constant
                                          : out.parts[static_cast<std::size_t>(
                                                out.same_as[static_cast<std::size_t>(parameter)])];
      for (Eigen::Index i = 0; i < size; ++i)
        if (b[i] != 0) to.col(i) += value * b[i] * b;
    };
    add(spring.stiffness_parameter, spring.stiffness, out.constant_stiffness);
    add(spring.damping_parameter, spring.damping, out.constant_damping);
  }
  return out;
}

bool shows_groups(const Structure& s, const std::vector<SensorAxis>& axes,
                  const std::vector<std::uint8_t>& present) {
  bool above[2] = {false, false}, base[2] = {false, false};
  bool driven = false, base_has_axes = false;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].is_force && present[a] == 0) return false;
    driven = driven || axes[a].is_force;
    base_has_axes = base_has_axes || (axes[a].story == 0 && axes[a].horizontal());
    if (present[a] == 0 || !axes[a].horizontal()) continue;
    const Direction along = direction_of(s, axes[a]);
    (axes[a].story == 0 ? base : above)[along == Direction::x ? 0 : 1] = true;
  }
  const bool rests = driven && !base_has_axes;
  return (rests || ((base[0] || !above[0]) && (base[1] || !above[1]))) && (above[0] || above[1]);
}

}  // namespace framewatch::estimator
