// SPDX-License-Identifier: MIT
#include "estimator/structure/story_groups.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace framewatch::estimator {
namespace {

struct Line {
  int first, count;
};

Line lines_of(const Structure& s, Direction direction) {
  return direction == Direction::x ? Line{0, s.n()} : Line{s.n(), s.m()};
}

/// Adds `share` of the floor's motion along `direction` at position `at_m` across it to the frames'
/// weights.
void add_motion(const Structure& s, Direction direction, double at_m, double share,
                std::vector<double>& weights) {
  const Line line = lines_of(s, direction);
  if (line.count == 0) return;
  const auto add = [&](int frame, double w) { weights[static_cast<std::size_t>(frame)] += w; };
  const bool rigid = s.floor == FloorModel::rigid;
  if (line.count == 1) {
    add(line.first, share);
    const Line other = lines_of(s, direction == Direction::x ? Direction::y : Direction::x);
    if (!rigid || other.count < 2) return;
    // The frames of the other direction show how the floor rotates.
    const int a = other.first, b = other.first + other.count - 1;
    const double arm = (at_m - line_position(s, line.first)) /
                       (line_position(s, b) - line_position(s, a)) * -share;
    add(b, arm);
    add(a, -arm);
    return;
  }
  int lower = line.first, upper = line.first + line.count - 1;
  if (!rigid) {
    while (lower + 1 < line.first + line.count - 1 && line_position(s, lower + 1) <= at_m) ++lower;
    upper = lower + 1;
  }
  const double from = line_position(s, lower), to = line_position(s, upper);
  const double part = (at_m - from) / (to - from);
  add(lower, share * (1 - part));
  add(upper, share * part);
}

/// Returns true if the axes of every measured floor show both translations and the rotation.
bool shows_rotation(const Structure& s, const std::vector<SensorAxis>& axes) {
  for (int story = 1; story <= s.stories; ++story) {
    std::vector<std::vector<double>> rows;
    for (const SensorAxis& axis : axes)
      if (axis.story == story) rows.push_back(frame_weights(s, axis));
    if (rows.empty()) continue;
    int rank = 0;  // of the rows in the rigid motions, by Gram-Schmidt
    std::vector<std::vector<double>> basis;
    for (const std::vector<double>& weights : rows) {
      std::vector<double> v(3, 0.0);
      for (int f = 0; f < s.frames(); ++f) {
        const double w = weights[static_cast<std::size_t>(f)];
        const bool x = s.direction(f) == Direction::x;
        v[x ? 0 : 1] += w;
        v[2] += w * line_position(s, f) * (x ? -1 : 1) /
                std::max({line_position(s, s.frames() - 1), line_position(s, s.n() - 1), 1e-9});
      }
      for (const std::vector<double>& b : basis) {
        const double along = v[0] * b[0] + v[1] * b[1] + v[2] * b[2];
        for (int i = 0; i < 3; ++i)
          v[static_cast<std::size_t>(i)] -= along * b[static_cast<std::size_t>(i)];
      }
      const double norm = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (norm < 1e-3) continue;
      for (double& value : v) value /= norm;
      basis.push_back(v);
      ++rank;
    }
    if (rank < 3) return false;
  }
  return true;
}

/// Appends the groups of a set of frames. `floors` are their measured floors, ascending. Stories
/// above the highest one form a further group.
void add_groups(const Structure& s, Direction direction, const std::vector<int>& frames,
                std::vector<int> floors, const WantedGroups& wanted, std::vector<StoryGroup>& out) {
  if (floors.empty()) return;
  if (!wanted.floors.empty())
    std::erase_if(floors, [&](int floor) {
      return std::find(wanted.floors.begin(), wanted.floors.end(), floor) == wanted.floors.end();
    });
  if (floors.empty() || floors.back() < s.stories) floors.push_back(s.stories);
  const bool whole = static_cast<int>(frames.size()) == lines_of(s, direction).count;
  int below = 0;
  for (const int floor : floors) {
    out.push_back({direction, below + 1, floor, frames, whole});
    below = floor;
  }
}

std::vector<int> floors_where(const Structure& s, const std::vector<SensorAxis>& axes,
                              const auto& counts) {
  std::vector<int> floors;
  for (int story = 1; story <= s.stories; ++story)
    if (std::any_of(axes.begin(), axes.end(),
                    [&](const SensorAxis& a) { return a.story == story && counts(a); }))
      floors.push_back(story);
  return floors;
}

std::vector<int> all_of(const Line& line) {
  std::vector<int> frames;
  for (int f = line.first; f < line.first + line.count; ++f) frames.push_back(f);
  return frames;
}

void add_rigid_groups(const Structure& s, const std::vector<SensorAxis>& axes, Direction direction,
                      bool rotation_shown, const WantedGroups& wanted,
                      std::vector<StoryGroup>& out) {
  const Line line = lines_of(s, direction);
  const std::vector<int> floors =
      floors_where(s, axes, [&](const SensorAxis& a) { return direction_of(s, a) == direction; });
  if (rotation_shown && line.count == 2) {
    for (int f = line.first; f < line.first + 2; ++f)
      add_groups(s, direction, {f}, floors, wanted, out);
  } else {
    add_groups(s, direction, all_of(line), floors, wanted, out);
  }
}

void add_flexible_groups(const Structure& s, const std::vector<SensorAxis>& axes,
                         Direction direction, const WantedGroups& wanted,
                         std::vector<StoryGroup>& out) {
  const Line line = lines_of(s, direction);
  std::vector<int> measured;
  for (int f = line.first; f < line.first + line.count; ++f)
    if (!floors_where(s, axes, [&](const SensorAxis& a) { return a.frame == f; }).empty())
      measured.push_back(f);
  if (measured.empty())  // all axes are between the frames
    return add_rigid_groups(s, axes, direction, false, wanted, out);
  std::vector<std::vector<int>> sets(measured.size());
  for (int f = line.first; f < line.first + line.count; ++f) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < measured.size(); ++i)
      if (std::abs(line_position(s, measured[i]) - line_position(s, f)) <
          std::abs(line_position(s, measured[nearest]) - line_position(s, f)))
        nearest = i;
    sets[nearest].push_back(f);
  }
  for (std::size_t i = 0; i < measured.size(); ++i)
    add_groups(s, direction, sets[i],
               floors_where(s, axes, [&](const SensorAxis& a) { return a.frame == measured[i]; }),
               wanted, out);
}

bool on_every_frame(const Structure& s, const std::vector<SensorAxis>& axes) {
  std::vector<bool> seen(static_cast<std::size_t>(s.degrees_of_freedom()), false);
  for (const SensorAxis& axis : axes) {
    if (axis.plan) return false;
    if (axis.story > 0 && axis.frame >= 0)
      seen[static_cast<std::size_t>(s.dof(axis.story, axis.frame))] = true;
  }
  return std::all_of(seen.begin(), seen.end(), [](bool b) { return b; });
}

}  // namespace

double line_position(const Structure& s, int frame) {
  const std::vector<double>& spans = frame < s.n() ? s.span_y : s.span_x;
  const int line = frame < s.n() ? frame : frame - s.n();
  double at = 0;
  const std::size_t given = std::min(static_cast<std::size_t>(std::max(line, 0)), spans.size());
  for (std::size_t i = 0; i < given; ++i) at += spans[i];
  return at;
}

std::vector<double> frame_weights(const Structure& s, const SensorAxis& axis) {
  std::vector<double> weights(static_cast<std::size_t>(s.frames()), 0.0);
  if (axis.frame >= 0) {
    weights[static_cast<std::size_t>(axis.frame)] = 1;
  } else if (axis.plan) {
    add_motion(s, Direction::x, axis.plan->y_m, std::cos(axis.plan->angle_rad), weights);
    add_motion(s, Direction::y, axis.plan->x_m, std::sin(axis.plan->angle_rad), weights);
  } else {
    const Line across = lines_of(s, axis.direction);
    const double middle =
        across.count > 0 ? line_position(s, across.first + across.count - 1) / 2 : 0;
    add_motion(s, axis.direction, middle, 1, weights);
  }
  return weights;
}

StoryGroups story_groups(const Structure& s, const std::vector<SensorAxis>& all,
                         const WantedGroups& wanted) {
  std::vector<SensorAxis> axes = horizontals(all);
  const bool forced = axes.size() < all.size();
  std::erase_if(axes, [](const SensorAxis& axis) { return axis.check; });
  StoryGroups out;
  out.every_story = !forced && on_every_frame(s, axes) && wanted.floors.empty() && !wanted.bending;
  if (out.every_story) return out;
  const bool rigid = s.floor == FloorModel::rigid;
  const bool rotation = rigid && shows_rotation(s, axes);
  for (const Direction direction : {Direction::x, Direction::y}) {
    if (rigid)
      add_rigid_groups(s, axes, direction, rotation, wanted, out.groups);
    else
      add_flexible_groups(s, axes, direction, wanted, out.groups);
  }
  return out;
}

}  // namespace framewatch::estimator
