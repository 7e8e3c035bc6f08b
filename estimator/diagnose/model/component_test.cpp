#include "estimator/diagnose/model/component_test.h"

namespace framewatch::estimator {

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
