// SPDX-License-Identifier: MIT
#include "tests/support/example_effects.h"

#include <algorithm>
#include <vector>

#include "estimator/structure/natural_frequencies.h"

namespace framewatch::test {

TableModel table_model(estimator::FloorModel floor) {
  estimator::Structure s;
  s.name = "table model";
  s.stories = 2;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2"};
  s.span_x = {1.0};
  s.span_y = {1.0};
  s.story_height = {1.0, 1.0};
  s.floor = floor;
  s.node_mass.assign(8, 20.0);
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  const double stiffness[] = {38e3, 22e3, 32e3, 19e3, 23e3, 36e3, 21e3, 33e3, 45e3, 40e3};
  for (int i = 0; i < table.elements(); ++i) theta[i] = stiffness[i];
  theta = with_proportional_damping(s, table, theta, 0.01);
  std::vector<estimator::SensorAxis> axes;
  for (const estimator::Direction direction : {estimator::Direction::x, estimator::Direction::y}) {
    estimator::SensorAxis base;
    base.name = direction == estimator::Direction::x ? "base-x" : "base-y";
    base.direction = direction;
    axes.push_back(base);
  }
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      estimator::SensorAxis axis;
      axis.name = "F" + std::to_string(story) + "-" + s.frame_name(f);
      axis.story = story;
      axis.frame = f;
      axis.direction = s.direction(f);
      axes.push_back(axis);
    }
  }
  return {s, theta, axes};
}

namespace {

/// Parameters with which an effect of the table is visible; empty if it has none.
std::vector<double> example_values(estimator::EffectKind kind, double size) {
  using enum estimator::EffectKind;
  switch (kind) {
    case cubic_stiffness:
      return {size * 5e8};
    case quadratic_stiffness:
      return {size * 2e6};
    case bilinear_hysteresis:
      return {size * 1e4, 1.5e-3};
    case bouc_wen:
      return {size * 1e4, 1.5e-3, 2, 0.6};
    case pinching:
      return {size * 1e4, 1.5e-3, 2, 0.6, 0.8, 0.3};
    case coulomb_friction:
      return {size * 10, 2e-3};
    case quadratic_damping:
      return {size * 1e3};
    case amplitude_dependence:
      return {size * 0.3, 20e-3, 2, size * 0.1};
    case one_sided_gap:
      return {size * 3e4, 2e-3, -1};
    case two_sided_gap:
      return {size * 3e4, 2e-3};
    case p_delta:
      return {size * 3e3};
    case extra_mass:
      return {size * 3};
    case tuned_mass_damper:
      return {size * 2, 3, 0.05};
    case base_rocking:
    case frame_bending:
      return {3e5 / (size > 0 ? size : 1e-10)};
    case added_spring:
      return {size * 3e3};
    case added_damper:
      return {size * 100};
    case modal_damping:
      return {size * 0.05};
    case stiffness_drop:
      return {-size * 5e3, 2};
    case stiffness_drift:
      return {-size * 5e3, 1, 2};
    case floor_flexibility:
      return {2e4 / (size > 0 ? size : 1e-6), 30};
    case unmeasured_force:
      return {size * 20, 3, 0.4, size * 10, 0.5, 8, 3, 0.5};
    case gain_error:
      return {size * 0.1};
    case misalignment:
      return {size * 5};
    case time_shift:
      return {size * 0.012};
    case clipping:
      return {size > 0 ? 1.5 / size : 1e9};
    case bias_drift:
      return {size * 0.02, 1};
    case polarity:
    case swapped:
      return {};
  }
  return {};
}

}  // namespace

estimator::Effect example_effect(estimator::EffectKind kind, const TableModel& model, double size) {
  estimator::Effect e = make_effect(kind, effect_places(kind, model.structure, model.axes).front());
  const std::vector<double> values = example_values(kind, size);  // others at their defaults
  std::copy(values.begin(), values.end(), e.values.begin());
  return e;
}

}  // namespace framewatch::test
