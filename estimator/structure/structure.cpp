#include "estimator/structure/structure.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace framewatch {
namespace {

bool all_positive(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double v) { return std::isfinite(v) && v > 0; });
}

std::string size_problem(const char* what, std::size_t found, int wanted) {
  return std::string(what) + ": expected " + std::to_string(wanted) + " values, found " +
         std::to_string(found);
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

std::vector<std::string> problems(const Structure& s) {
  std::vector<std::string> found;
  if (s.stories < 1) found.push_back("stories: must be at least 1");
  if (s.frames() < 1) found.push_back("frames_x, frames_y: at least one frame is needed");
  const auto check_size = [&](const char* what, std::size_t size, int wanted) {
    if (size != static_cast<std::size_t>(std::max(wanted, 0)))
      found.push_back(size_problem(what, size, std::max(wanted, 0)));
  };
  check_size("span_x_m", s.span_x.size(), s.m() - 1);
  check_size("span_y_m", s.span_y.size(), s.n() - 1);
  check_size("story_height_m", s.story_height.size(), s.stories);
  check_size("node_mass_kg", s.node_mass.size(), s.nodes());
  if (!all_positive(s.span_x)) found.push_back("span_x_m: every span must be > 0");
  if (!all_positive(s.span_y)) found.push_back("span_y_m: every span must be > 0");
  if (!all_positive(s.story_height)) found.push_back("story_height_m: every height must be > 0");
  if (!all_positive(s.node_mass)) found.push_back("node_mass_kg: every mass must be > 0");
  std::set<std::string> names;
  for (int f = 0; f < s.frames(); ++f) {
    if (s.frame_name(f).empty()) found.push_back("frames: a frame needs a name");
    if (!names.insert(s.frame_name(f)).second)
      found.push_back("frames: '" + s.frame_name(f) + "' is named twice");
  }
  return found;
}

}  // namespace framewatch
