#include "estimator/diagnose/model/make_plant.h"

#include <algorithm>
#include <utility>

#include "estimator/diagnose/model/partial_plant.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {

using Eigen::VectorXd;

namespace {

constexpr double kStiff = 2000;         ///< of a panel that acts as rigid, over the stiffest frame
constexpr double kStiffDamping = 1e-9;  ///< of such a panel, over its stiffness, s

VectorXd with_stiff_panels(const Structure& s, const ParameterTable& all,
                           const ParameterTable& believed, const VectorXd& design) {
  VectorXd out = VectorXd::Zero(all.size());
  const double stiff = kStiff * design.head(believed.elements()).maxCoeff();
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      const int to = all.frame_stiffness(story, f), from = believed.frame_stiffness(story, f);
      out[to] = design[from];
      out[to + all.elements()] = design[from + believed.elements()];
    }
    for (int p = 0; p < s.panels(); ++p) {
      out[all.panel_stiffness(story, p)] = stiff;
      out[all.panel_stiffness(story, p) + all.elements()] = kStiffDamping * stiff;
    }
  }
  return out;
}

}  // namespace

std::optional<Plant> make_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const VectorXd& design, double rate_hz,
                                const BendingStiffness& bending) {
  const ParameterTable table(structure);
  const double highest_hz = natural_frequencies_hz(structure, table, design).back();
  const bool at_places =  // vertical axes have one
      std::any_of(axes.begin(), axes.end(), [](const SensorAxis& a) { return a.plan.has_value(); });
  const auto partial = [&] {
    auto out = partial_plant(structure, axes, design, bending, rate_hz);
    if (out) out->highest_hz = highest_hz;
    return out;
  };
  if (at_places || has_force(axes) || bending.any()) return partial();
  Structure flexible = structure;
  flexible.floor = FloorModel::flexible;
  const ParameterTable all(flexible);
  if (structure.floor == FloorModel::rigid && flexible.panels() > 0) {
    if (auto building = measured_building(flexible, all, axes, rate_hz)) {
      Plant out(flexible, axes, with_stiff_panels(flexible, all, table, design),
                std::move(*building));
      out.stiff_floors = true;
      out.highest_hz = highest_hz;
      return out;
    }
  }
  auto building = measured_building(structure, table, axes, rate_hz);
  if (!building) return partial();
  Plant out(structure, axes, design, std::move(*building));
  out.highest_hz = highest_hz;
  return out;
}

}  // namespace framewatch::estimator
