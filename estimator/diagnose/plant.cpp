#include "estimator/diagnose/plant.h"

#include <utility>

namespace framewatch {

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
      elements(framewatch::elements(s, table)),
      constraint(floor_constraint(s)) {
  const Matrices matrices = assemble(s, table, VectorXd::Zero(table.size()));
  mass = (constraint.transpose() * matrices.mass.asDiagonal() * constraint).diagonal();
  motion = mass.cwiseInverse().asDiagonal() * building.mass;
  ground = MatrixXd::Zero(s.degrees_of_freedom(), building.axes());
  for (const Element& e : elements) {
    if (e.frame < 0 || e.story != 1) continue;
    const VectorXd share =
        building.act.col(e.stiffness).transpose() * motion - building.sense.row(e.stiffness);
    for (int story = 1; story <= s.stories; ++story)
      ground.row(s.dof(story, e.frame)) = share.transpose();
  }
}

std::optional<Plant> make_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const VectorXd& design, double rate_hz) {
  const ParameterTable table(structure);
  auto building = measured_building(structure, table, axes, rate_hz);
  if (!building) return std::nullopt;
  return Plant(structure, axes, design, std::move(*building));
}

}  // namespace framewatch
