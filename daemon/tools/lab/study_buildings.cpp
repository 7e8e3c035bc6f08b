// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/study_buildings.h"

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/core.h>

#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kDampingRatio = 0.02;

/// Returns theta for stiffnesses in kN/m and kN/(rad*m), table order.
Eigen::VectorXd theta_of(const estimator::Structure& structure,
                         const std::vector<double>& stiffness_kn) {
  const estimator::ParameterTable table(structure);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  theta.head(table.elements()) =
      1e3 * Eigen::Map<const Eigen::VectorXd>(stiffness_kn.data(), table.elements());
  return with_proportional_damping(structure, table, theta, kDampingRatio);
}

constexpr double kTallDamping = 0.015, kTopShare = 0.35;

double between(estimator::Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

int count(estimator::Random& random, int low, int high) {
  return low + static_cast<int>(random.uniform() * (high - low + 1));
}

std::vector<double> spans(estimator::Random& random, int frames) {
  std::vector<double> out;
  for (int i = 1; i < frames; ++i) out.push_back(between(random, 3, 9));
  return out;
}

std::vector<std::string> names(const char* axis, int frames) {
  std::vector<std::string> out;
  for (int i = 1; i <= frames; ++i) out.push_back(axis + std::to_string(i));
  return out;
}

estimator::SensorAxis axis_of(const std::string& name, int story, int frame,
                              estimator::Direction direction) {
  estimator::SensorAxis out;
  out.name = name;
  out.story = story;
  out.frame = frame;
  out.direction = direction;
  return out;
}

}  // namespace

estimator::Structure table1() {
  estimator::Structure s;
  s.name = "paper, Table 1";
  s.stories = 5;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2"};
  s.span_x = {10.7};
  s.span_y = {15.0};
  s.story_height.assign(5, 4.0);
  s.node_mass.assign(static_cast<std::size_t>(s.nodes()), 16.5e3);
  return s;
}

Eigen::VectorXd table1_theta() {
  return theta_of(table1(), {
                                3500, 2000, 3000, 2500, 2500, 2000, 2300, 2500, 2500, 2000,  // kx
                                2000, 3000, 3000, 2000, 2500, 3000, 2000, 2500, 2500, 2000,  // ky
                                250,  230,  200,  210,  230                                  // Gk
                            });
}

estimator::Structure table2() {
  estimator::Structure s;
  s.name = "paper, Table 2";
  s.stories = 2;
  s.frames_x = {"y1", "y2", "y3", "y4"};
  s.frames_y = {"x1", "x2", "x3", "x4"};
  s.span_x = {5.0, 3.0, 4.0};
  s.span_y = {3.0, 4.0, 2.0};
  s.story_height.assign(2, 4.0);
  s.node_mass.assign(static_cast<std::size_t>(s.nodes()), 5.0e3);
  return s;
}

Eigen::VectorXd table2_theta(char variant) {
  std::vector<double> stiffness = {3500, 2000, 2000, 3000, 2500, 2000, 2500, 3000,
                                   3000, 2500, 3000, 2000, 2300, 2500, 2000, 2500};
  std::vector<double> floor;
  if (variant == 'b') floor = {100, 110, 120, 210, 220, 230, 310, 320, 330};
  if (variant == 'c') floor = {2000, 2500, 2000, 2500, 2500, 2500, 3000, 2500, 3000};
  if (variant == 'd') floor = {6000, 6500, 6000, 5500, 5000, 5500, 4000, 4500, 4000};
  for (int story = 0; story < 2; ++story)
    stiffness.insert(stiffness.end(), floor.begin(), floor.end());
  return theta_of(table2(), stiffness);
}

std::vector<estimator::SensorAxis> full_sensor_axes(const estimator::Structure& s) {
  std::vector<estimator::SensorAxis> axes;
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      axes.push_back(
          axis_of(fmt::format("F{}-{}", story, s.frame_name(f)), story, f, s.direction(f)));
  if (s.n() > 0) axes.push_back(axis_of("F0-x", 0, -1, estimator::Direction::x));
  if (s.m() > 0) axes.push_back(axis_of("F0-y", 0, -1, estimator::Direction::y));
  return axes;
}

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
    for (const int frame : {0, 2, 3})
      axes.push_back(axis_of(fmt::format("F{}-{}", level, frame), level, frame,
                             frame == 0 ? estimator::Direction::x : estimator::Direction::y));
  return axes;
}

std::vector<estimator::SensorAxis> floor_axes(const std::vector<int>& floors) {
  std::vector<estimator::SensorAxis> axes{axis_of("base", 0, -1, estimator::Direction::x)};
  for (const int floor : floors)
    axes.push_back(axis_of(fmt::format("F{}", floor), floor, 0, estimator::Direction::x));
  return axes;
}

RandomBuilding random_building(std::uint64_t seed) {
  constexpr double kFirstMode_hz[] = {0.8, 3};
  estimator::Random random(seed, 77);
  RandomBuilding out;
  estimator::Structure& s = out.structure;
  s.name = "random building " + std::to_string(seed);
  s.stories = count(random, 1, 6);
  s.frames_x = names("y", count(random, 1, 4));
  s.frames_y = names("x", count(random, 1, 4));
  s.span_x = spans(random, s.m());
  s.span_y = spans(random, s.n());
  s.story_height.assign(static_cast<std::size_t>(s.stories), 3.5);
  for (int i = 0; i < s.nodes(); ++i) s.node_mass.push_back(between(random, 5e3, 2e4));
  const estimator::ParameterTable table(s);
  out.truth.resize(table.size());
  for (int p = 0; p < table.elements(); ++p)
    out.truth[p] = between(random, 0.6, 1.6) *
                   (table[p].kind == estimator::ParameterKind::frame_stiffness ? 1.0 : 0.4);
  const double wanted_hz = between(random, kFirstMode_hz[0], kFirstMode_hz[1]);
  const double unit_hz = natural_frequencies_hz(s, table, out.truth).front();
  out.truth.head(table.elements()) *= (wanted_hz / unit_hz) * (wanted_hz / unit_hz);
  out.truth = with_proportional_damping(s, table, out.truth, between(random, 0.01, 0.04));
  for (int p = table.elements(); p < table.size(); ++p) out.truth[p] *= between(random, 0.5, 1.5);
  return out;
}

}  // namespace framewatch::daemon
