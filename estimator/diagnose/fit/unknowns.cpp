// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/unknowns.h"

#include <algorithm>
#include <limits>

namespace framewatch::estimator {
namespace {

using Kind = Unknown::Kind;

constexpr double kTightK = 0.6, kTightG = 1.0, kTightC = 3.0;  ///< weak priors, relative
constexpr double kLongestStep = 0.5;  ///< of a stiffness, relative to the design
constexpr double kMaxSigmas = 4;      ///< of masses, gains and clocks from their declared values
/// Lower bound, of the design's stiffness or damping. Structures dissipate, and the equation of a
/// mode that neither dissipates nor is driven from the base would have no noise.
constexpr double kMin = 0.02;
constexpr double kLooseGain = 0.05, kLooseClock_s = 1e-3;  ///< units
constexpr double kAny = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Unknown> unknowns_of(const Plant& plant, const Model& model,
                                 const Tolerances& tolerances) {
  std::vector<Unknown> out;
  const auto elements = static_cast<int>(plant.element_count());
  for (const int first : {0, elements})
    for (const TiedStories& group : plant.groups) {
      const auto scale = [&](int element) { return plant.design[first + element]; };
      const int at = group.elements.front();
      out.push_back({Kind::theta, first + at, 0, 0, scale(at), first == 0 ? kTightK : kTightC, 1.0,
                     kMin, kAny});
      for (std::size_t i = 1; i < group.elements.size(); ++i)
        out.back().tied.emplace_back(first + group.elements[i], scale(group.elements[i]));
      if (first == 0) out.back().longest_step = kLongestStep;
      out.back().stops_alone = plant.is_large();
    }
  for (int p = 0; p < 2 * elements && plant.groups.empty(); ++p) {
    const bool panel = plant.table[p].panel >= 0;
    if (panel && plant.stiff_floors) continue;
    const double sigma = (p < elements ? (panel ? kTightG : kTightK) : kTightC);
    const double scale = plant.design[p];
    out.push_back({Kind::theta, p, 0, 0, scale, sigma, 1.0, kMin, kAny});
    if (p < elements) out.back().longest_step = kLongestStep;
    out.back().stops_alone = plant.is_large();
  }
  if (tolerances.mass > 0)
    for (int i = 0; i < static_cast<int>(plant.equations()); ++i)
      out.push_back({Kind::mass, i, 0, 0, tolerances.mass, 1.0, 0.0, -kMaxSigmas, kMaxSigmas});
  const auto freed = [](const std::vector<int>& list, int axis) {
    for (const int i : list)
      if (i == axis) return true;
    return false;
  };
  // An axis error that is an effect has neither prior nor bounds.
  const auto add_axis = [&](Kind kind, int axis, bool loose, double scale, double center) {
    out.push_back(loose ? Unknown{kind, axis, 0, 0, scale, 0.0, center, -kAny, kAny}
                        : Unknown{kind, axis, 0, 0, scale, 1.0, center, center - kMaxSigmas,
                                  center + kMaxSigmas});
  };
  for (int a = 0; a < static_cast<int>(plant.axis_count()); ++a) {
    const bool loose = freed(model.free_gain, a);
    if (loose || tolerances.gain > 0)
      add_axis(Kind::gain, a, loose, loose ? kLooseGain : tolerances.gain, 0.0);
  }
  for (int a = 0; a < static_cast<int>(plant.axis_count()); ++a) {
    const bool loose = freed(model.free_clock, a);
    const double scale = loose ? kLooseClock_s : tolerances.clock_s;
    if (scale > 0)
      add_axis(Kind::clock, a, loose, scale, plant.axes[static_cast<std::size_t>(a)].delay / scale);
  }
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    const ModelEffect& effect = model.effects[e];
    const auto add = [&](const LawParameter& parameter, Kind kind, std::size_t index,
                         std::size_t record) {
      if (parameter.free)
        out.push_back({kind, static_cast<int>(e), static_cast<int>(index), static_cast<int>(record),
                       parameter.step, parameter.sigma > 0 ? parameter.sigma / parameter.step : 0.0,
                       parameter.center / parameter.step, parameter.low / parameter.step,
                       parameter.high / parameter.step});
    };
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
      add(effect.parameters[k], Kind::parameter, k, 0);
    for (std::size_t r = 0; r < effect.record_parameters.size(); ++r)
      for (std::size_t k = 0; k < effect.record_parameters[r].size(); ++k)
        add(effect.record_parameters[r][k], Kind::record_parameter, k, r);
  }
  return out;
}

bool is_tolerated(const Unknown& unknown) {
  const bool may_be =
      unknown.kind == Kind::mass || unknown.kind == Kind::gain || unknown.kind == Kind::clock;
  return may_be && unknown.sigma > 0;
}

namespace {

double& member(Model& model, const Unknown& u) {
  switch (u.kind) {
    case Kind::theta:
      return model.theta[u.index];
    case Kind::mass:
      return model.mass_change[u.index];
    case Kind::gain:
      return model.gain[u.index];
    case Kind::clock:
      return model.clock_s[u.index];
    case Kind::parameter:
      return model.effects[static_cast<std::size_t>(u.index)]
          .parameters[static_cast<std::size_t>(u.parameter)]
          .value;
    case Kind::record_parameter:
      break;
  }
  return model.effects[static_cast<std::size_t>(u.index)]
      .record_parameters[static_cast<std::size_t>(u.record)][static_cast<std::size_t>(u.parameter)]
      .value;
}

}  // namespace

double value_of(const Model& model, const Unknown& u) {
  return member(const_cast<Model&>(model), u) / u.scale;
}

void set_value(Model& model, const Unknown& u, double value) {
  const double within = std::clamp(value, u.low, u.high);
  member(model, u) = within * u.scale;
  for (const auto& [index, scale] : u.tied) model.theta[index] = within * scale;
}

}  // namespace framewatch::estimator
