// SPDX-License-Identifier: MIT
#include "estimator/structure/structure.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace framewatch::estimator {
namespace {

bool all_positive(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double v) { return std::isfinite(v) && v > 0; });
}

}  // namespace

int Structure::panels() const {
  if (floor == FloorModel::rigid || n() < 2 || m() < 2) return 0;
  return (n() - 1) * (m() - 1);
}

const std::string& Structure::frame_name(int frame) const {
  return frame < n() ? frames_x[static_cast<std::size_t>(frame)]
                     : frames_y[static_cast<std::size_t>(frame - n())];
}

int Structure::nodes() const {
  return stories * std::max(n(), 1) * std::max(m(), 1);
}

double Structure::frame_mass(int story, int frame) const {
  const int rows = std::max(n(), 1);
  const int columns = std::max(m(), 1);
  const auto node = [&](int y, int x) {
    return node_mass[static_cast<std::size_t>(((story - 1) * rows + y) * columns + x)];
  };
  double sum = 0;
  if (frame < n()) {
    for (int x = 0; x < columns; ++x) sum += node(frame, x);
  } else {
    for (int y = 0; y < rows; ++y) sum += node(y, frame - n());
  }
  return sum;
}

bool bends_as_a_whole(const Structure& s, Direction direction) {
  constexpr int kTall = 10;
  constexpr double kSlender = 3;
  const std::vector<double>& spans = direction == Direction::x ? s.span_x : s.span_y;
  const double width = std::accumulate(spans.begin(), spans.end(), 0.0);
  const double height = std::accumulate(s.story_height.begin(), s.story_height.end(), 0.0);
  return s.stories >= kTall || (width > 0 && height > kSlender * width);
}

std::vector<Problem> find_problems(const Structure& s) {
  std::vector<Problem> found;
  const auto add = [&](const std::string& field, const std::string& rule) {
    found.push_back({field, -1, field + ": " + rule});
  };
  if (s.stories < 1) add("stories", "must be at least 1");
  if (s.frames() < 1) found.push_back({"", -1, "frames_x, frames_y: at least one frame is needed"});
  const auto check_values = [&](const char* field, const std::vector<double>& values, int wanted) {
    const int size = std::max(wanted, 0);
    if (values.size() != static_cast<std::size_t>(size)) {
      add(field,
          "expected " + std::to_string(size) + " values, found " + std::to_string(values.size()));
    } else if (!all_positive(values)) {
      add(field, "every value must be > 0");
    }
  };
  check_values("span_x_m", s.span_x, s.m() - 1);
  check_values("span_y_m", s.span_y, s.n() - 1);
  check_values("story_height_m", s.story_height, s.stories);
  check_values("node_mass_kg", s.node_mass, s.nodes());
  std::set<std::string> names;
  for (int f = 0; f < s.frames(); ++f) {
    const char* field = s.direction(f) == Direction::x ? "frames_x" : "frames_y";
    if (s.frame_name(f).empty()) add(field, "a frame needs a name");
    if (!names.insert(s.frame_name(f)).second)
      add(field, "'" + s.frame_name(f) + "' is the name of two frames");
  }
  const auto check_labels = [&](const char* field, const std::vector<std::string>& labels,
                                std::size_t frames) {
    if (!labels.empty() && labels.size() != frames)
      add(field, "expected " + std::to_string(frames) + " labels, one for each frame, found " +
                     std::to_string(labels.size()));
    for (const std::string& label : labels)
      if (!names.insert(label).second) add(field, "'" + label + "' is the name of two frames");
  };
  check_labels("labels_x", s.labels_x, s.frames_x.size());
  check_labels("labels_y", s.labels_y, s.frames_y.size());
  return found;
}

std::vector<std::string> problems(const Structure& s) {
  std::vector<std::string> messages;
  for (const Problem& problem : find_problems(s)) messages.push_back(problem.message);
  return messages;
}

std::string crossing_name(const Structure& s, int crossing) {
  const int columns = std::max(s.m(), 1);
  return (s.m() > 0 ? s.frames_y[static_cast<std::size_t>(crossing % columns)] : "") +
         (s.n() > 0 ? s.frames_x[static_cast<std::size_t>(crossing / columns)] : "");
}

std::string panel_name(const Structure& s, int panel) {
  const int columns = s.m() - 1;
  return s.frames_y[static_cast<std::size_t>(panel % columns)] +
         s.frames_x[static_cast<std::size_t>(panel / columns)];
}

}  // namespace framewatch::estimator
