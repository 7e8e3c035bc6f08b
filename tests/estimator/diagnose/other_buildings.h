// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "estimator/diagnose/model/make_plant.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::test {

/// The small building with a floor that is declared rigid.
inline Small rigid_small() {
  Small out;
  const Eigen::VectorXd frames = out.truth.head(4);
  out.structure.floor = estimator::FloorModel::rigid;
  out.table = estimator::ParameterTable(out.structure);
  out.truth = Eigen::VectorXd::Zero(out.table.size());
  out.truth.head(4) = frames;
  out.truth = with_proportional_damping(out.structure, out.table, out.truth, 0.02);
  out.design = 1.05 * out.truth;
  return out;
}

/// One frame of one story: a single mass on a spring.
struct SingleMass {
  estimator::Structure structure = Small::one_story();
  std::vector<estimator::SensorAxis> axes;
  double stiffness = 8e6, damping = 5e4;

  SingleMass() {
    structure.frames_x = {"y1"};
    structure.frames_y.clear();
    structure.span_x.clear();
    structure.span_y.clear();
    structure.node_mass = {40e3};
    axes.push_back({"top", 1, estimator::Direction::x, 0});
    axes.push_back({"base", 0, estimator::Direction::x, -1});
  }

  estimator::Plant plant() const {
    return *make_plant(structure, axes, Eigen::Vector2d(stiffness, damping), kRate_hz);
  }
};

/// Stories with Small's plan and design, one on top of the other, with an axis on every frame of
/// every floor. Eleven are a large building (Plant::is_large).
inline Small tower(int stories) {
  const Small one;
  Small out;
  estimator::Structure& s = out.structure;
  s.stories = stories;
  s.story_height.assign(static_cast<std::size_t>(stories), one.structure.story_height[0]);
  s.node_mass.clear();
  for (int i = 0; i < stories; ++i)
    s.node_mass.insert(s.node_mass.end(), one.structure.node_mass.begin(),
                       one.structure.node_mass.end());
  out.table = estimator::ParameterTable(s);
  out.truth = Eigen::VectorXd::Zero(out.table.size());
  for (int story = 1; story <= stories; ++story) {
    for (int f = 0; f < 4; ++f)
      out.truth[out.table.frame_stiffness(story, f)] = one.truth[one.table.frame_stiffness(1, f)];
    out.truth[out.table.panel_stiffness(story, 0)] = one.truth[one.table.panel_stiffness(1, 0)];
  }
  out.truth = with_proportional_damping(s, out.table, out.truth, 0.02);
  out.design = 1.05 * out.truth;
  out.axes.clear();
  for (int story = 1; story <= stories; ++story)
    for (int f = 0; f < 4; ++f)
      out.axes.push_back({s.frame_name(f) + "-" + std::to_string(story), story, s.direction(f), f});
  out.axes.push_back({"base-x", 0, estimator::Direction::x, -1});
  out.axes.push_back({"base-y", 0, estimator::Direction::y, -1});
  return out;
}

/// Three equal stories of Table 1's plan.
inline estimator::Plant three_stories() {
  estimator::Structure s = table1();
  s.stories = 3;
  s.story_height.resize(3);
  s.node_mass.resize(static_cast<std::size_t>(s.nodes()));
  const estimator::ParameterTable table(s);
  Eigen::VectorXd design(table.size());
  design << Eigen::VectorXd::Constant(table.elements(), 8e6),
      Eigen::VectorXd::Constant(table.elements(), 5e4);
  return *make_plant(s, full_sensor_axes(s), design, kRate_hz);
}

}  // namespace framewatch::test
