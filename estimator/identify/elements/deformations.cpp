// SPDX-License-Identifier: MIT
#include "estimator/identify/elements/deformations.h"

#include <cmath>

#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {

Deformations::Deformations(const Structure& s, const FloorLayout& layout,
                           const std::vector<SensorAxis>& axes)
    : layout_(&layout), noise_density_(noise_densities(axes)) {
  const int frames = layout.frames();
  place_.resize(static_cast<std::size_t>((s.stories + 1) * frames));
  const auto place = [&](int floor, int frame) -> std::vector<Weighted>& {
    return place_[static_cast<std::size_t>(floor * frames + frame)];
  };
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (!axes[a].horizontal()) continue;
    if (axes[a].frame >= 0) place(axes[a].story, axes[a].frame) = {{static_cast<int>(a), 1.0}};
  }
  for (int f = 0; f < frames; ++f) {
    if (!place(0, f).empty()) continue;
    std::vector<int> own_frame;  // base axes on other frames of this direction
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (axes[a].story != 0 || !axes[a].horizontal()) continue;
      if (axes[a].frame < 0 && axes[a].direction == s.direction(f))
        place(0, f) = {{static_cast<int>(a), 1.0}};
      if (axes[a].frame >= 0 && s.direction(axes[a].frame) == s.direction(f))
        own_frame.push_back(static_cast<int>(a));
    }
    if (!place(0, f).empty() || own_frame.empty()) continue;
    // The base turns as a plane: the least-squares line through its measured frames gives the
    // others.
    double mean = 0, spread = 0;
    const auto at = [&](int axis) {
      return line_position(s, axes[static_cast<std::size_t>(axis)].frame);
    };
    for (const int a : own_frame) mean += at(a) / static_cast<double>(own_frame.size());
    for (const int a : own_frame) spread += (at(a) - mean) * (at(a) - mean);
    for (const int a : own_frame) {
      const double slope =
          spread > 0 ? (at(a) - mean) * (line_position(s, f) - mean) / spread : 0.0;
      place(0, f).push_back({a, 1.0 / static_cast<double>(own_frame.size()) + slope});
    }
  }
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < frames; ++f) mass_.push_back(s.frame_mass(story, f));
  for (int p = 0; p < s.panels(); ++p) {
    const int j = p % (s.m() - 1);
    const int l = p / (s.m() - 1);
    panels_.push_back({l, l + 1, s.n() + j, s.n() + j + 1,
                       layout.coefficient(2 * frames + p, l + 1),
                       layout.coefficient(2 * frames + p, s.n() + j + 1)});
  }
}

DeformationSet Deformations::make_set() const {
  return {std::vector<double>(static_cast<std::size_t>(floors() * stride()), 0.0),
          std::vector<std::uint8_t>(place_.size(), 0)};
}

void Deformations::compute(const DriftControlledIntegrator& motion, DeformationSet& set) const {
  const int frames = layout_->frames();
  const int panels = layout_->panels();
  struct Point {
    double value = 0, first = 0, second = 0;
    bool known = false;
  };
  const auto point = [&](int floor, int f) {
    Point p;
    p.known = !at(floor, f).empty();
    for (const Weighted& w : at(floor, f)) {
      p.value += w.weight * motion.value(w.axis);
      p.first += w.weight * motion.first(w.axis);
      p.second += w.weight * motion.second(w.axis);
      p.known = p.known && motion.valid(w.axis);
    }
    if (!p.known) p = Point{};
    return p;
  };
  for (int f = 0; f < frames; ++f) {
    Point below = point(0, f);
    set.known[static_cast<std::size_t>(f)] = below.known;
    for (int floor = 0; floor < floors(); ++floor) {
      const Point here = point(floor + 1, f);
      double* out = &set.values[static_cast<std::size_t>(floor * stride())];
      out[f] = here.value - below.value;
      out[frames + f] = here.first - below.first;
      out[layout_->own() + f] = mass_[static_cast<std::size_t>(floor * frames + f)] * here.second;
      set.known[static_cast<std::size_t>((floor + 1) * frames + f)] = here.known;
      below = here;
    }
  }
  if (panels == 0) return;
  for (int floor = 0; floor < floors(); ++floor) {
    double* out = &set.values[static_cast<std::size_t>(floor * stride())];
    for (int p = 0; p < panels; ++p) {
      const Panel& panel = panels_[static_cast<std::size_t>(p)];
      const Point u0 = point(floor + 1, panel.u0), u1 = point(floor + 1, panel.u1);
      const Point v0 = point(floor + 1, panel.v0), v1 = point(floor + 1, panel.v1);
      out[2 * frames + p] = panel.bu * (u1.value - u0.value) + panel.bv * (v1.value - v0.value);
      out[2 * frames + panels + p] =
          panel.bu * (u1.first - u0.first) + panel.bv * (v1.first - v0.first);
    }
  }
}

DeformationSet AxisMotion::make_set() const {
  const auto axes = static_cast<std::size_t>(axes_);
  return {std::vector<double>(axes * kSignals, 0.0), std::vector<std::uint8_t>(axes, 0)};
}

void AxisMotion::compute(const DriftControlledIntegrator& motion, DeformationSet& set) const {
  double* out = set.values.data();
  for (int axis = 0; axis < axes_; ++axis) {
    set.known[static_cast<std::size_t>(axis)] = motion.valid(axis) ? 1 : 0;
    *out++ = motion.value(axis);
    *out++ = motion.first(axis);
    *out++ = motion.second(axis);
    *out++ = motion.held_first(axis);
    *out++ = motion.held_second(axis);
  }
}

}  // namespace framewatch::estimator
