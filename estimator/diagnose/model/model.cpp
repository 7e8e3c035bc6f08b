#include "estimator/diagnose/model/model.h"

#include <algorithm>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kBendingStep = 0.1, kMaxBending = 100;  ///< of the design's flexibility

}  // namespace

LawValues ModelEffect::law(std::size_t record) const {
  LawValues out{form, {}, deformation, rate, 1.0};
  for (const LawParameter& parameter : parameters) out.p.push_back(parameter.plain());
  if (record < record_parameters.size())
    for (const LawParameter& parameter : record_parameters[record])
      out.p.push_back(parameter.plain());
  return out;
}

Model initial_model(const Plant& plant) {
  Model out;
  out.theta = plant.design;
  out.mass_change = VectorXd::Zero(plant.equations());
  out.gain = VectorXd::Zero(plant.axis_count());
  out.clock_s = VectorXd::Zero(plant.axis_count());
  for (Index a = 0; a < plant.axis_count(); ++a)
    out.clock_s[a] = plant.axes[static_cast<std::size_t>(a)].delay;
  for (const Direction along : {Direction::x, Direction::y}) {
    const double stiffness = plant.bending[along == Direction::x ? 0 : 1];
    if (!(stiffness > 0)) continue;
    ModelEffect bending;
    bending.form = LawForm::bending;
    bending.place.kind = PlaceKind::building;
    bending.place.direction = along;
    bending.parameters = {
        bounded_parameter(1 / stiffness, kBendingStep / stiffness, 0, kMaxBending / stiffness)};
    bending.parameters[0].sigma = bending.parameters[0].centre = 1 / stiffness;
    out.effects.push_back(bending);
  }
  return out;
}

int element_of(const Plant& plant, const EffectPlace& place) {
  return place.kind == PlaceKind::panel ? plant.table.panel_stiffness(place.story, place.panel)
                                        : plant.table.frame_stiffness(place.story, place.frame);
}

std::vector<int> frames_at(const Structure& s, int crossing) {
  const int columns = std::max(s.m(), 1);
  std::vector<int> out;
  if (s.n() > 0) out.push_back(crossing / columns);
  if (s.m() > 0) out.push_back(s.n() + crossing % columns);
  return out;
}

VectorXd node_direction(const Plant& plant, int story, int frame) {
  return plant.constraint.row(plant.structure.dof(story, frame)).transpose();
}

}  // namespace framewatch::estimator
