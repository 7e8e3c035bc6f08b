// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/law_port.h"

#include <algorithm>

namespace framewatch::estimator {
namespace {

using Eigen::RowVectorXd;
using Eigen::VectorXd;

LawPort element_port(const Plant& plant, int element) {
  return {plant.building.act.col(element), plant.building.sense.row(element), element, 1};
}

LawPort between_floors(const Plant& plant, const EffectPlace& place) {
  LawPort out;
  out.act = node_direction(plant, place.story, place.frame);
  out.sense = out.act.transpose() * plant.motion;
  if (place.to_story > 0) {
    const VectorXd lower = node_direction(plant, place.to_story, place.frame);
    out.act -= lower;
    out.sense -= lower.transpose() * plant.motion;
  } else {
    out.sense -= plant.ground.row(plant.structure.dof(place.story, place.frame));
  }
  return out;
}

std::vector<LawPort> ports_of_frames(const Plant& plant, const Model& model,
                                     const EffectPlace& place) {
  std::vector<LawPort> out;
  double sum = 0;
  for (const Element& e : plant.elements) {
    if (e.frame < 0) continue;
    const bool own = place.kind == PlaceKind::whole_frame
                         ? e.frame == place.frame
                         : plant.structure.direction(e.frame) == place.direction;
    if (!own) continue;
    out.push_back(element_port(plant, e.stiffness));
    out.back().scale = model.theta[e.stiffness];
    sum += out.back().scale;
  }
  for (LawPort& port : out) port.scale *= static_cast<double>(out.size()) / sum;
  return out;
}

}  // namespace

std::vector<LawPort> law_ports(const Plant& plant, const Model& model, const ModelEffect& effect) {
  switch (effect.place.kind) {
    case PlaceKind::building:
    case PlaceKind::whole_frame:
      return ports_of_frames(plant, model, effect.place);
    case PlaceKind::node_pair:
    case PlaceKind::node:
      return {between_floors(plant, effect.place)};
    default:
      return {element_port(plant, element_of(plant, effect.place))};
  }
}

std::vector<ActiveLaw> active_laws(const Plant& plant, const Model& model) {
  std::vector<ActiveLaw> out;
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    if (!model.effects[e].element_law()) continue;
    for (LawPort& port : law_ports(plant, model, model.effects[e]))
      out.push_back({e, std::move(port)});
  }
  return out;
}

LawValues law_at(const Model& model, const ActiveLaw& active, std::size_t record) {
  LawValues out = model.effects[active.effect].law(record);
  out.scale = active.port.scale;
  return out;
}

}  // namespace framewatch::estimator
