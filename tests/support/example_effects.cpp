#include "tests/support/example_effects.h"

namespace framewatch::test {

TableModel table_model(FloorModel floor) {
  Structure s;
  s.name = "table model";
  s.stories = 2;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2"};
  s.span_x = {1.0};
  s.span_y = {1.0};
  s.story_height = {1.0, 1.0};
  s.floor = floor;
  s.node_mass.assign(8, 20.0);
  const ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  const double stiffness[] = {38e3, 22e3, 32e3, 19e3, 23e3, 36e3, 21e3, 33e3, 45e3, 40e3};
  for (int i = 0; i < table.elements(); ++i) theta[i] = stiffness[i];
  theta = with_proportional_damping(s, table, theta, 0.01);
  std::vector<SensorAxis> axes;
  for (const Direction direction : {Direction::x, Direction::y}) {
    SensorAxis base;
    base.name = direction == Direction::x ? "base-x" : "base-y";
    base.direction = direction;
    axes.push_back(base);
  }
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      SensorAxis axis;
      axis.name = "F" + std::to_string(story) + "-" + s.frame_name(f);
      axis.story = story;
      axis.frame = f;
      axis.direction = s.direction(f);
      axes.push_back(axis);
    }
  }
  return {s, theta, axes};
}

Effect example_effect(EffectKind kind, const TableModel& model, double size) {
  Effect e = make_effect(kind, effect_places(kind, model.structure, model.axes).front());
  const auto give = [&](std::initializer_list<double> values) { e.values = values; };
  using enum EffectKind;
  switch (kind) {
    case cubic_stiffness:
      give({size * 5e8});
      break;
    case quadratic_stiffness:
      give({size * 2e6});
      break;
    case bilinear_hysteresis:
      give({size * 1e4, 1.5e-3});
      break;
    case bouc_wen:
      give({size * 1e4, 1.5e-3, 2, 0.6});
      break;
    case pinching:
      give({size * 1e4, 1.5e-3, 2, 0.6, 0.8, 0.3});
      break;
    case coulomb_friction:
      give({size * 10, 2e-3});
      break;
    case quadratic_damping:
      give({size * 1e3});
      break;
    case one_sided_gap:
      give({size * 3e4, 2e-3, -1});
      break;
    case two_sided_gap:
      give({size * 3e4, 2e-3});
      break;
    case p_delta:
      give({size * 3e3});
      break;
    case extra_mass:
      give({size * 3});
      break;
    case tuned_mass_damper:
      give({size * 2, 3, 0.05});
      break;
    case base_rocking:
    case frame_bending:
      give({3e5 / (size > 0 ? size : 1e-10)});
      break;
    case added_spring:
      give({size * 3e3});
      break;
    case added_damper:
      give({size * 100});
      break;
    case stiffness_drop:
      give({-size * 5e3, 2});
      break;
    case stiffness_drift:
      give({-size * 5e3, 1, 2});
      break;
    case floor_flexibility:
      give({2e4 / (size > 0 ? size : 1e-6), 30});
      break;
    case unmeasured_force:
      give({size * 20, 3, 0.4, size * 10, 0.5, 8, 3, 0.5});
      break;
    case gain_error:
      give({size * 0.1});
      break;
    case misalignment:
      give({size * 5});
      break;
    case time_shift:
      give({size * 0.012});
      break;
    case clipping:
      give({size > 0 ? 1.5 / size : 1e9});
      break;
    case bias_drift:
      give({size * 0.02, 1});
      break;
    case polarity:
    case swapped:
      break;
  }
  return e;
}

}  // namespace framewatch::test
