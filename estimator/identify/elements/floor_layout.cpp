// SPDX-License-Identifier: MIT
#include "estimator/identify/elements/floor_layout.h"

namespace framewatch::estimator {

FloorLayout::FloorLayout(const Structure& s, const ParameterTable& table,
                         const std::vector<SensorAxis>& axes)
    : grouped_(table.grouped()),
      floors_(grouped_ ? 1 : s.stories),
      frames_(s.frames()),
      panels_(s.panels()),
      rows_(grouped_ ? static_cast<int>(axes.size()) : frames_),
      places_(grouped_ ? static_cast<int>(axes.size()) : (floors_ + 1) * frames_),
      own_(grouped_ ? table.size() : 2 * frames_ + 2 * panels_) {
  if (grouped_) {
    for (int p = 0; p < table.size(); ++p) parameter_.push_back(p);
    for (const int p : parameter_) kind_.push_back(table[p].kind);
    return;
  }
  for (int floor = 0; floor < floors_; ++floor) {
    const int story = floor + 1;
    for (int f = 0; f < frames_; ++f) parameter_.push_back(table.frame_stiffness(story, f));
    for (int f = 0; f < frames_; ++f) parameter_.push_back(table.frame_damping(story, f));
    for (int p = 0; p < panels_; ++p) parameter_.push_back(table.panel_stiffness(story, p));
    for (int p = 0; p < panels_; ++p) parameter_.push_back(table.panel_damping(story, p));
  }
  for (int p = 0; p < own_; ++p) kind_.push_back(table[parameter(0, p)].kind);
  coefficient_.assign(static_cast<std::size_t>((own() + 2 * frames_) * frames_), 0.0);
  const auto set = [&](int position, int f, double value) {
    coefficient_[static_cast<std::size_t>(position * frames_ + f)] = value;
  };
  for (int f = 0; f < frames_; ++f) {
    set(f, f, 1);
    set(frames_ + f, f, 1);
    set(own() + f, f, -1);
    set(own() + frames_ + f, f, -1);
  }
  for (const Element& e : elements(s, table)) {
    if (e.panel < 0 || e.story != 1) continue;
    for (const auto& [dof, b] : e.b) {
      set(2 * frames_ + e.panel, dof, b);
      set(2 * frames_ + panels_ + e.panel, dof, b);
    }
  }
}

int FloorLayout::parameter(int floor, int position) const {
  return parameter_[static_cast<std::size_t>(floor * own() + position)];
}

}  // namespace framewatch::estimator
