#include <algorithm>
#include <limits>

#include "estimator/diagnose/fit.h"

namespace framewatch {
namespace {

constexpr double kTightK = 0.6, kTightG = 1.0, kTightC = 3.0;  ///< weak priors, relative
constexpr double kMostSigmas = 4;                              ///< of what is only tolerated
/// Of the design, a stiffness or a damping: what does not dissipate is no structure, and a mode
/// that neither dissipates nor is driven from the base would have no noise in its equation.
constexpr double kLeast = 0.02;
constexpr double kLooseGain = 0.05, kLooseClock_s = 1e-3;  ///< units
constexpr double kAny = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Unknown> unknowns_of(const Plant& plant, const Model& model,
                                 const Tolerances& tolerances) {
  using Kind = Unknown::Kind;
  std::vector<Unknown> out;
  const auto elements = static_cast<int>(plant.element_count());
  for (int p = 0; p < 2 * elements; ++p) {
    const bool panel = plant.table[p].panel >= 0;
    if (panel && plant.stiff_floors) continue;
    const double sigma = (p < elements ? (panel ? kTightG : kTightK) : kTightC);
    const double scale = plant.design[p];
    out.push_back({Kind::theta, p, 0, 0, scale, sigma, 1.0, kLeast, kAny});
  }
  if (tolerances.mass > 0)
    for (int i = 0; i < static_cast<int>(plant.equations()); ++i)
      out.push_back({Kind::mass, i, 0, 0, tolerances.mass, 1.0, 0.0, -kMostSigmas, kMostSigmas});
  const auto freed = [](const std::vector<int>& list, int axis) {
    for (const int i : list)
      if (i == axis) return true;
    return false;
  };
  // An axis' error that is an effect may be anything.
  const auto add_axis = [&](Kind kind, int axis, bool loose, double scale, double centre) {
    out.push_back(loose ? Unknown{kind, axis, 0, 0, scale, 0.0, centre, -kAny, kAny}
                        : Unknown{kind, axis, 0, 0, scale, 1.0, centre, centre - kMostSigmas,
                                  centre + kMostSigmas});
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
    const auto add = [&](const Knob& knob, Kind kind, std::size_t index, std::size_t record) {
      if (knob.free)
        out.push_back({kind, static_cast<int>(e), static_cast<int>(index), static_cast<int>(record),
                       knob.step, knob.sigma > 0 ? knob.sigma / knob.step : 0.0,
                       knob.centre / knob.step, knob.low / knob.step, knob.high / knob.step});
    };
    for (std::size_t k = 0; k < effect.knobs.size(); ++k) add(effect.knobs[k], Kind::knob, k, 0);
    for (std::size_t r = 0; r < effect.record_knobs.size(); ++r)
      for (std::size_t k = 0; k < effect.record_knobs[r].size(); ++k)
        add(effect.record_knobs[r][k], Kind::record_knob, k, r);
  }
  return out;
}

namespace {

double& member(Model& model, const Unknown& u) {
  using Kind = Unknown::Kind;
  switch (u.kind) {
    case Kind::theta:
      return model.theta[u.index];
    case Kind::mass:
      return model.mass_change[u.index];
    case Kind::gain:
      return model.gain[u.index];
    case Kind::clock:
      return model.clock_s[u.index];
    case Kind::knob:
      return model.effects[static_cast<std::size_t>(u.index)]
          .knobs[static_cast<std::size_t>(u.knob)]
          .value;
    case Kind::record_knob:
      break;
  }
  return model.effects[static_cast<std::size_t>(u.index)]
      .record_knobs[static_cast<std::size_t>(u.record)][static_cast<std::size_t>(u.knob)]
      .value;
}

}  // namespace

double value_of(const Model& model, const Unknown& u) {
  return member(const_cast<Model&>(model), u) / u.scale;
}

void set_value(Model& model, const Unknown& u, double value) {
  member(model, u) = std::clamp(value, u.low, u.high) * u.scale;
}

}  // namespace framewatch
