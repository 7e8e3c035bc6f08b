#include "daemon/tools/lab/tall_buildings.h"

#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kTallDamping = 0.015, kTopShare = 0.35;

}  // namespace

estimator::Structure tall_building(int stories) {
  estimator::Structure s;
  s.name = fmt::format("{} stories", stories);
  s.stories = stories;
  s.frames_x = {"y1"};
  s.story_height.assign(static_cast<std::size_t>(stories), 3.5);
  s.node_mass.assign(static_cast<std::size_t>(stories), 800e3);
  return s;
}

Eigen::VectorXd tall_design(int stories) {
  const estimator::Structure s = tall_building(stories);
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  for (int story = 0; story < stories; ++story)
    theta[story] = 1e9 * (1 - (1 - kTopShare) * story / (stories - 1.0));
  theta.tail(stories) = theta.head(stories);
  const double f1_hz = 10.0 / stories;
  theta.head(stories) *= std::pow(f1_hz / natural_frequencies_hz(s, table, theta).front(), 2);
  theta.tail(stories) = theta.head(stories) * 2 * kTallDamping / (2 * std::numbers::pi * f1_hz);
  return theta;
}

estimator::Structure tall_building_in_space(int stories) {
  estimator::Structure s = tall_building(stories);
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2"};
  s.span_x = {36};
  s.span_y = {24};
  s.floor = estimator::FloorModel::rigid;
  s.node_mass.assign(static_cast<std::size_t>(4 * stories), 200e3);
  return s;
}

Eigen::VectorXd tall_design_in_space(int stories) {
  // Eccentric by 15 % of the plan, so that floors turn.
  constexpr double kShare[] = {0.65, 0.35, 0.4, 0.75};
  const Eigen::VectorXd plane = tall_design(stories);
  const estimator::ParameterTable table(tall_building_in_space(stories));
  Eigen::VectorXd theta(table.size());
  for (int story = 1; story <= stories; ++story)
    for (int f = 0; f < 4; ++f) {
      theta[table.frame_stiffness(story, f)] = kShare[f] * plane[story - 1];
      theta[table.frame_damping(story, f)] = kShare[f] * plane[stories + story - 1];
    }
  return theta;
}

std::vector<estimator::SensorAxis> floor_axes_in_space(const std::vector<int>& floors) {
  std::vector<int> levels{0};
  levels.insert(levels.end(), floors.begin(), floors.end());
  std::vector<estimator::SensorAxis> axes;
  for (const int level : levels)
    for (const int frame : {0, 2, 3}) {
      estimator::SensorAxis axis;
      axis.name = fmt::format("F{}-{}", level, frame);
      axis.story = level;
      axis.frame = frame;
      axis.direction = frame == 0 ? estimator::Direction::x : estimator::Direction::y;
      axes.push_back(axis);
    }
  return axes;
}

std::vector<estimator::SensorAxis> floor_axes(const std::vector<int>& floors) {
  std::vector<estimator::SensorAxis> axes(1);
  axes[0].name = "base";
  for (const int floor : floors) {
    axes.emplace_back();
    axes.back().name = fmt::format("F{}", floor);
    axes.back().story = floor;
    axes.back().frame = 0;
  }
  return axes;
}

}  // namespace framewatch::daemon
