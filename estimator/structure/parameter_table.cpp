// SPDX-License-Identifier: MIT
#include "estimator/structure/parameter_table.h"

#include <cmath>

#include "estimator/structure/structure.h"

namespace framewatch::estimator {

ParameterTable::ParameterTable(const Structure& s)
    : stories_(s.stories), n_(s.n()), m_(s.m()), panels_(s.panels()) {
  const auto add_group = [&](const char* prefix, ParameterKind kind, int first, int count,
                             const char* unit) {
    const bool panel =
        kind == ParameterKind::panel_stiffness || kind == ParameterKind::panel_damping;
    for (int story = 1; story <= s.stories; ++story) {
      for (int i = first; i < first + count; ++i) {
        const std::string place = panel ? panel_name(s, i) : s.frame_name(i);
        parameters_.push_back({std::string(prefix) + "_" + std::to_string(story) + "_" + place,
                               kind, story, panel ? -1 : i, panel ? i : -1, unit, story,
                               panel ? std::vector<int>{} : std::vector<int>{i},
                               panel ? Direction::x : s.direction(i)});
      }
    }
  };
  add_group("kx", ParameterKind::frame_stiffness, 0, n_, "N/m");
  add_group("ky", ParameterKind::frame_stiffness, n_, m_, "N/m");
  add_group("Gk", ParameterKind::panel_stiffness, 0, panels_, "N/(rad*m)");
  add_group("cx", ParameterKind::frame_damping, 0, n_, "N*s/m");
  add_group("cy", ParameterKind::frame_damping, n_, m_, "N*s/m");
  add_group("Gc", ParameterKind::panel_damping, 0, panels_, "N*s/(rad*m)");
  elements_ = size() / 2;
}

ParameterTable::ParameterTable(const Structure& s, const StoryGroups& groups,
                               const BendingStiffness& bending)
    : ParameterTable(s) {
  if (groups.every_story) return;
  parameters_.clear();
  group_of_.assign(static_cast<std::size_t>(s.degrees_of_freedom()), -1);
  for (const bool damping : {false, true}) {
    for (const StoryGroup& g : groups.groups) {
      const bool one_frame = g.frames.size() == 1;
      const bool one_story = g.first == g.last;
      std::string name = damping ? "c" : "k";
      name += g.direction == Direction::x ? "x_" : "y_";
      name += std::to_string(g.first);
      if (!one_story) name += "to" + std::to_string(g.last);
      if (!g.whole_direction || (one_frame && one_story)) {
        for (std::size_t i = 0; i < g.frames.size(); ++i)
          name += (i == 0 ? "_" : "+") + s.frame_name(g.frames[i]);
      }
      parameters_.push_back(
          {name, damping ? ParameterKind::frame_damping : ParameterKind::frame_stiffness, g.first,
           one_frame ? g.frames[0] : -1, -1, damping ? "N*s/m" : "N/m", g.last, g.frames,
           g.direction});
      for (int story = g.first; story <= g.last && !damping; ++story)
        for (const int f : g.frames)
          group_of_[static_cast<std::size_t>(s.dof(story, f))] = size() - 1;
    }
    if (!damping) elements_ = size();
  }
  for (const Direction direction : {Direction::x, Direction::y}) {
    const bool x = direction == Direction::x;
    if (!(bending[x ? 0 : 1] > 0)) continue;
    std::vector<int> frames;
    for (int f = 0; f < s.frames(); ++f)
      if (s.direction(f) == direction) frames.push_back(f);
    parameters_.push_back({x ? "krx" : "kry", ParameterKind::bending_stiffness, 1,
                           frames.size() == 1 ? frames[0] : -1, -1, "N*m/rad", s.stories, frames,
                           direction});
  }
}

int ParameterTable::frame_stiffness(int story, int frame) const {
  if (grouped()) return group_of_[static_cast<std::size_t>((story - 1) * (n_ + m_) + frame)];
  if (frame < n_) return (story - 1) * n_ + frame;
  return stories_ * n_ + (story - 1) * m_ + (frame - n_);
}

int ParameterTable::panel_stiffness(int story, int panel) const {
  return stories_ * (n_ + m_) + (story - 1) * panels_ + panel;
}

std::optional<int> ParameterTable::find(const std::string& name) const {
  for (int i = 0; i < size(); ++i)
    if ((*this)[i].name == name) return i;
  return std::nullopt;
}

double design_tolerance(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::frame_stiffness:
      return 0.1;
    case ParameterKind::panel_stiffness:
    case ParameterKind::frame_damping:
      return 0.3;
    case ParameterKind::panel_damping:
    case ParameterKind::bending_stiffness:
      return 0.5;
  }
  return 0.1;
}

}  // namespace framewatch::estimator
