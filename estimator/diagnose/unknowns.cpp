#include <algorithm>

#include "estimator/diagnose/fit.h"

namespace framewatch {
namespace {

constexpr double kTightK = 0.6, kTightG = 1.0, kTightC = 3.0;  ///< weak priors, relative
constexpr double kMostSigmas = 4;                              ///< of what is only tolerated

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
    out.push_back({Kind::theta, p, 0, 0, scale, sigma, 1.0});
  }
  if (tolerances.mass > 0)
    for (int i = 0; i < static_cast<int>(plant.equations()); ++i)
      out.push_back({Kind::mass, i, 0, 0, tolerances.mass, 1.0, 0.0});
  const auto freed = [](const std::vector<int>& list, int axis) {
    for (const int i : list)
      if (i == axis) return true;
    return false;
  };
  for (int a = 0; a < static_cast<int>(plant.axis_count()); ++a) {
    const bool loose = freed(model.free_gain, a);
    if (loose || tolerances.gain > 0)
      out.push_back({Kind::gain, a, 0, 0, loose ? 0.05 : tolerances.gain, loose ? 0.0 : 1.0, 0.0});
  }
  for (int a = 0; a < static_cast<int>(plant.axis_count()); ++a) {
    const bool loose = freed(model.free_clock, a);
    if (loose || tolerances.clock_s > 0)
      out.push_back(
          {Kind::clock, a, 0, 0, loose ? 1e-3 : tolerances.clock_s, loose ? 0.0 : 1.0,
           plant.axes[static_cast<std::size_t>(a)].delay / (loose ? 1e-3 : tolerances.clock_s)});
  }
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    const ModelEffect& effect = model.effects[e];
    const auto add = [&](const Knob& knob, Kind kind, std::size_t index, std::size_t record) {
      if (knob.free)
        out.push_back({kind, static_cast<int>(e), static_cast<int>(index), static_cast<int>(record),
                       knob.step, knob.sigma > 0 ? knob.sigma / knob.step : 0.0,
                       knob.centre / knob.step});
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
  double to = value * u.scale;
  const bool tolerated = u.kind == Unknown::Kind::mass || u.kind == Unknown::Kind::gain ||
                         u.kind == Unknown::Kind::clock;
  if (tolerated && u.sigma > 0)
    to = std::clamp(to, (u.centre - kMostSigmas) * u.scale, (u.centre + kMostSigmas) * u.scale);
  if (u.kind == Unknown::Kind::knob || u.kind == Unknown::Kind::record_knob) {
    const ModelEffect& e = model.effects[static_cast<std::size_t>(u.index)];
    const Knob& knob =
        u.kind == Unknown::Kind::knob
            ? e.knobs[static_cast<std::size_t>(u.knob)]
            : e.record_knobs[static_cast<std::size_t>(u.record)][static_cast<std::size_t>(u.knob)];
    to = std::clamp(to, knob.low, knob.high);
  }
  member(model, u) = to;
}

}  // namespace framewatch
