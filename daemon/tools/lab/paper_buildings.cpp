#include "daemon/tools/lab/paper_buildings.h"

#include <string>

#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kDampingRatio = 0.02;

/// theta from stiffnesses in kN/m and kN/(rad*m), table order.
Eigen::VectorXd theta_of(const estimator::Structure& structure,
                         const std::vector<double>& stiffness_kn) {
  const estimator::ParameterTable table(structure);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  theta.head(table.elements()) =
      1e3 * Eigen::Map<const Eigen::VectorXd>(stiffness_kn.data(), table.elements());
  return with_proportional_damping(structure, table, theta, kDampingRatio);
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
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      estimator::SensorAxis axis;
      axis.name = "F" + std::to_string(story) + "-" + s.frame_name(f);
      axis.story = story;
      axis.direction = s.direction(f);
      axis.frame = f;
      axes.push_back(axis);
    }
  }
  const auto add_base = [&](const char* name, estimator::Direction direction) {
    estimator::SensorAxis axis;
    axis.name = name;
    axis.direction = direction;
    axes.push_back(axis);
  };
  if (s.n() > 0) add_base("F0-x", estimator::Direction::x);
  if (s.m() > 0) add_base("F0-y", estimator::Direction::y);
  return axes;
}

}  // namespace framewatch::daemon
