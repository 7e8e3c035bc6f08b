// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/make_plant.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "estimator/identify/groups/floor_coordinates.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A basis of motions as columns over all coordinates, floor by floor.
class Motions {
 public:
  explicit Motions(Index coordinates) : coordinates_(coordinates) {}
  void add(Index first, const MatrixXd& of_floor) {
    for (Index c = 0; c < of_floor.cols(); ++c) {
      columns_.push_back(VectorXd::Zero(coordinates_));
      columns_.back().segment(first, of_floor.rows()) = of_floor.col(c);
    }
  }
  MatrixXd matrix() const {
    MatrixXd out(coordinates_, static_cast<Index>(columns_.size()));
    for (std::size_t c = 0; c < columns_.size(); ++c) out.col(static_cast<Index>(c)) = columns_[c];
    return out;
  }

 private:
  Index coordinates_;
  std::vector<VectorXd> columns_;
};

/// The building's coordinates as read by the axes, and the motions that the axes do not read.
struct ReadMotion {
  MatrixXd of_axes;  ///< coordinates x axes
  MatrixXd read, unread;
};

ReadMotion read_motion(const Structure& s, const std::vector<SensorAxis>& axes,
                       const MatrixXd& constraint) {
  const std::vector<std::uint8_t> all(axes.size(), 1);
  ReadMotion out{MatrixXd::Zero(constraint.cols(), static_cast<Index>(axes.size())), {}, {}};
  Motions read(constraint.cols()), unread(constraint.cols());
  Index first = 0;
  for (int story = 1; story <= s.stories; ++story) {
    const FloorCoordinates floor = floor_coordinates(s, axes, all, story);
    const Index count = floor.frames.cols(), measured = floor.measured;
    const MatrixXd own = constraint.block(s.dof(story, 0), first, s.frames(), count);
    MatrixXd change(count, count);  // from the floor's coordinates to the building's
    const LeastSquares solver(own);
    for (Index c = 0; c < count; ++c) change.col(c) = solver.solve(VectorXd(floor.frames.col(c)));
    out.of_axes.middleRows(first, count) = change.leftCols(measured) * floor.from_axes;
    if (measured == count) {
      read.add(first, MatrixXd::Identity(count, count));
    } else if (measured == 0) {
      unread.add(first, MatrixXd::Identity(count, count));
    } else {
      const MatrixXd basis = orthogonal_basis(change.rightCols(count - measured));
      unread.add(first, basis.leftCols(count - measured));
      read.add(first, basis.rightCols(measured));
    }
    first += count;
  }
  out.read = read.matrix();
  out.unread = unread.matrix();
  return out;
}

std::vector<TiedStories> tied_stories(const Structure& s, const std::vector<SensorAxis>& axes,
                                      const ParameterTable& table,
                                      const BendingStiffness& bending) {
  std::vector<TiedStories> out;
  for (const StoryGroup& group : story_groups(s, axes, {{}, bending.any()}).groups) {
    TiedStories& one = out.emplace_back();
    for (int story = group.first; story <= group.last; ++story)
      for (const int f : group.frames) one.elements.push_back(table.frame_stiffness(story, f));
  }
  return out;
}

/// Returns the directions of the measured forces on the equations, with opposite signs
/// (Plant::push).
MatrixXd pushed(const Structure& s, const std::vector<SensorAxis>& axes, const MatrixXd& constraint,
                Index columns) {
  MatrixXd out = MatrixXd::Zero(constraint.cols(), columns);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (!axes[a].is_force) continue;
    const std::vector<double> weights = frame_weights(s, axes[a]);
    out.col(static_cast<Index>(a)) =
        -constraint.middleRows(s.dof(axes[a].story, 0), s.frames()).transpose() *
        Eigen::Map<const VectorXd>(weights.data(), s.frames());
  }
  return out;
}

constexpr double kStiff = 2000;         ///< of a panel that acts as rigid, over the stiffest frame
constexpr double kStiffDamping = 1e-9;  ///< of such a panel, over its stiffness, s

VectorXd with_stiff_panels(const Structure& s, const ParameterTable& all,
                           const ParameterTable& believed, const VectorXd& design) {
  VectorXd out = VectorXd::Zero(all.size());
  const double stiff = kStiff * design.head(believed.elements()).maxCoeff();
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      const int to = all.frame_stiffness(story, f), from = believed.frame_stiffness(story, f);
      out[to] = design[from];
      out[to + all.elements()] = design[from + believed.elements()];
    }
    for (int p = 0; p < s.panels(); ++p) {
      out[all.panel_stiffness(story, p)] = stiff;
      out[all.panel_stiffness(story, p) + all.elements()] = kStiffDamping * stiff;
    }
  }
  return out;
}

}  // namespace

std::optional<Plant> partial_plant(const Structure& s, const std::vector<SensorAxis>& axes,
                                   const VectorXd& design, const BendingStiffness& bending,
                                   double rate_hz) {
  const std::vector<std::uint8_t> all(axes.size(), 1);
  if (!shows_groups(s, axes, all)) return std::nullopt;
  const ParameterTable table(s);
  const MatrixXd constraint = floor_constraint(s);
  const ReadMotion seen = read_motion(s, axes, constraint);
  const FloorCoordinates base = base_coordinates(s, axes, all);
  const MatrixXd base_frames = base.frames * base.from_axes;
  const std::array<Eigen::RowVectorXd, 2> rocking = base_rotations(axes, all);
  const auto count = static_cast<Index>(axes.size());

  MeasuredBuilding building;
  MatrixXd motion(constraint.cols(), count + seen.unread.cols());
  motion << seen.of_axes, seen.unread;
  const VectorXd frame_mass = assemble(s, table, VectorXd::Zero(table.size())).mass;
  building.mass = constraint.transpose() * frame_mass.asDiagonal() * constraint * motion;
  MatrixXd vectors = MatrixXd::Zero(s.degrees_of_freedom(), table.elements());
  MatrixXd ground = MatrixXd::Zero(table.elements(), motion.cols());
  for (const Element& e : estimator::elements(s, table)) {
    for (const auto& [dof, coefficient] : e.b) vectors(dof, e.stiffness) += coefficient;
    if (e.frame < 0) continue;
    auto moved = ground.row(e.stiffness).head(count);
    if (e.story == 1) moved = base_frames.row(e.frame);
    const Eigen::RowVectorXd& turned = rocking[s.direction(e.frame) == Direction::x ? 0 : 1];
    if (turned.size() > 0) moved += s.story_height[static_cast<std::size_t>(e.story - 1)] * turned;
  }
  building.act = constraint.transpose() * vectors;
  building.sense = building.act.transpose() * motion - ground;
  const std::vector<double> density = noise_densities(axes);
  building.variance.resize(count);
  building.delay.resize(count);
  for (Index a = 0; a < count; ++a) {
    building.variance[a] =
        0.5 * density[static_cast<std::size_t>(a)] * density[static_cast<std::size_t>(a)] * rate_hz;
    building.delay[a] = axes[static_cast<std::size_t>(a)].delay;
  }

  Plant out(s, axes, design, std::move(building));
  out.read = seen.read;
  out.unread = seen.unread;
  out.push = pushed(s, axes, constraint, motion.cols());
  out.groups = tied_stories(s, axes, table, bending);
  out.bending = bending;
  return out;
}

std::optional<Plant> make_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const VectorXd& design, double rate_hz,
                                const BendingStiffness& bending) {
  const ParameterTable table(structure);
  const double highest_hz = natural_frequencies_hz(structure, table, design).back();
  const bool at_places =  // vertical axes have one
      std::any_of(axes.begin(), axes.end(), [](const SensorAxis& a) { return a.plan.has_value(); });
  const auto partial = [&] {
    auto out = partial_plant(structure, axes, design, bending, rate_hz);
    if (out) out->highest_hz = highest_hz;
    return out;
  };
  if (at_places || has_force(axes) || bending.any()) return partial();
  Structure flexible = structure;
  flexible.floor = FloorModel::flexible;
  const ParameterTable all(flexible);
  if (structure.floor == FloorModel::rigid && flexible.panels() > 0) {
    if (auto building = measured_building(flexible, all, axes, rate_hz)) {
      Plant out(flexible, axes, with_stiff_panels(flexible, all, table, design),
                std::move(*building));
      out.stiff_floors = true;
      out.highest_hz = highest_hz;
      return out;
    }
  }
  auto building = measured_building(structure, table, axes, rate_hz);
  if (!building) return partial();
  Plant out(structure, axes, design, std::move(*building));
  out.highest_hz = highest_hz;
  return out;
}

}  // namespace framewatch::estimator
