#include "estimator/structure/parameter_table.h"

#include <cmath>

#include "estimator/structure/place_names.h"

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
                               kind, story, panel ? -1 : i, panel ? i : -1, unit});
      }
    }
  };
  add_group("kx", ParameterKind::frame_stiffness, 0, n_, "N/m");
  add_group("ky", ParameterKind::frame_stiffness, n_, m_, "N/m");
  add_group("Gk", ParameterKind::panel_stiffness, 0, panels_, "N/(rad*m)");
  add_group("cx", ParameterKind::frame_damping, 0, n_, "N*s/m");
  add_group("cy", ParameterKind::frame_damping, n_, m_, "N*s/m");
  add_group("Gc", ParameterKind::panel_damping, 0, panels_, "N*s/(rad*m)");
}

int ParameterTable::frame_stiffness(int story, int frame) const {
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
      return 0.5;
  }
  return 0.1;
}

}  // namespace framewatch::estimator
