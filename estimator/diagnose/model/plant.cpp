// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/plant.h"

#include <utility>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Plant::Plant(const Structure& s, const std::vector<SensorAxis>& sensors, VectorXd believed,
             MeasuredBuilding equations_of_motion)
    : structure(s),
      table(s),
      axes(sensors),
      design(std::move(believed)),
      building(std::move(equations_of_motion)),
      elements(estimator::elements(s, table)),
      constraint(floor_constraint(s)) {
  const Matrices matrices = assemble(s, table, VectorXd::Zero(table.size()));
  mass = (constraint.transpose() * matrices.mass.asDiagonal() * constraint).diagonal();
  motion = mass.cwiseInverse().asDiagonal() * building.mass;
  push = MatrixXd::Zero(building.equations(), building.axes());
  ground = MatrixXd::Zero(s.degrees_of_freedom(), building.axes());
  // Sums from story to story: a rocking base moves higher floors more.
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      const int at = table.frame_stiffness(story, f);
      ground.row(s.dof(story, f)) =
          building.act.col(at).transpose() * motion - building.sense.row(at);
      if (story > 1) ground.row(s.dof(story, f)) += ground.row(s.dof(story - 1, f));
    }
}

Plant with_force_axis(const Plant& plant, const SensorAxis& axis) {
  MeasuredBuilding wider = plant.building;
  const Index axes = wider.axes() + 1;
  const auto widen = [&](MatrixXd& m) {
    m.conservativeResize(Eigen::NoChange, axes);
    m.col(axes - 1).setZero();
  };
  widen(wider.mass);
  widen(wider.sense);
  for (VectorXd* v : {&wider.variance, &wider.delay}) {
    v->conservativeResize(axes);
    (*v)[axes - 1] = 0;
  }
  std::vector<SensorAxis> sensors = plant.axes;
  sensors.push_back(axis);
  Plant out(plant.structure, sensors, plant.design, std::move(wider));
  out.stiff_floors = plant.stiff_floors;
  out.highest_hz = plant.highest_hz;
  out.prescribed = plant.prescribed;
  out.push.leftCols(axes - 1) = plant.push;
  out.push.col(axes - 1) =
      -out.constraint.row(plant.structure.dof(axis.story, axis.frame)).transpose();
  return out;
}

Plant component_plant(const Plant& plant, const ComponentTest& component) {
  if (component.force.empty()) return plant;
  SensorAxis force;
  force.name = component.force;
  force.story = 1;
  force.frame = 0;
  Plant out = with_force_axis(plant, force);
  out.prescribed = component.prescribed;
  return out;
}

std::vector<char> displaced_axes(const Plant& plant, const ComponentTest& component) {
  std::vector<char> out(plant.axes.size(), 0);
  for (std::size_t i = 0; i < plant.axes.size(); ++i)
    out[i] = component.displacement && plant.axes[i].story == 1 &&
             !plant.is_force(static_cast<Eigen::Index>(i));
  return out;
}

}  // namespace framewatch::estimator
