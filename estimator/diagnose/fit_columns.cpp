#include <algorithm>
#include <cmath>
#include <complex>

#include "estimator/diagnose/fit.h"

namespace framewatch {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
constexpr Complex kJ{0, 1};
constexpr double kTightK = 0.6, kTightG = 1.0, kTightC = 3.0;  ///< weak priors, relative

constexpr double kMostSigmas = 4;  ///< of what is only tolerated

VectorXcd harmonic_bins(const ModelEffect& e, const Stretch& stretch, std::size_t record,
                        double hz) {
  VectorXd signal(stretch.intervals());
  const std::vector<Knob>& r = e.record_knobs[record];
  for (Index i = 0; i < signal.size(); ++i) {
    const double t = static_cast<double>(i) / stretch.rate_hz, phase = 2 * M_PI * hz * t;
    signal[i] =
        t < e.onset_s[record] ? 0 : r[0].value * std::cos(phase) + r[1].value * std::sin(phase);
  }
  return band_of(signal, stretch, 1);
}

VectorXd knob_column(const Plant& plant, const Model& model, const Stretch& stretch,
                     std::size_t record, const Whitened& system, const Unknown& unknown,
                     int ratio) {
  const ModelEffect& e = model.effects[static_cast<std::size_t>(unknown.index)];
  const Index rows = system.residual.size();
  Model moved = model;
  const double before = value_of(model, unknown);
  const double step = unknown.scale;
  set_value(moved, unknown, before + 1);
  const ModelEffect& to = moved.effects[static_cast<std::size_t>(unknown.index)];
  (void)step;
  if (e.element_law()) {
    std::size_t law = 0;
    for (int i = 0; i < unknown.index; ++i)
      law += model.effects[static_cast<std::size_t>(i)].element_law();
    const LawTrack& track = system.tracks[law];
    const VectorXd force =
        law_force(to.law(record), track.d, track.v, 1 / (stretch.rate_hz * ratio)) - track.force;
    return whiten_rows(system, plant.building.act.col(element_of(plant, e.place)),
                       band_of(force, stretch, ratio));
  }
  if (e.form == LawForm::harmonic) {
    const VectorXcd change = harmonic_bins(e, stretch, record, e.knobs[0].plain()) -
                             harmonic_bins(to, stretch, record, to.knobs[0].plain());
    return whiten_rows(system, node_direction(plant, e.place.story, e.place.frame), change);
  }
  if (e.form == LawForm::misaligned) {
    const double a = e.knobs[0].plain(), b = to.knobs[0].plain();
    const VectorXcd own = system.calibrated.row(e.place.channel).transpose();
    const VectorXcd other = system.calibrated.row(e.place.with_channel).transpose();
    const VectorXcd raw = own * std::cos(a) + std::sin(a) * other;
    return whiten_axis(system, e.place.channel, (raw - std::sin(b) * other) / std::cos(b) - own);
  }
  MatrixXcd change(plant.equations(), system.bins());
  for (Index b = 0; b < system.bins(); ++b)
    change.col(b) = (linear_operation(plant, moved, to, stretch.w[b]) -
                     linear_operation(plant, model, e, stretch.w[b])) *
                    system.motion.col(b);
  if (rows != 2 * change.size()) return VectorXd::Zero(rows);
  return whiten_rows(system, change);
}

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

VectorXd column_of(const Plant& plant, const Model& model, const Stretch& stretch,
                   std::size_t record, const Whitened& system, const Unknown& u, int ratio) {
  using Kind = Unknown::Kind;
  const Index elements = plant.element_count();
  switch (u.kind) {
    case Kind::theta: {
      const Index e = u.index % elements;
      const VectorXcd q = (plant.building.sense.row(e) * system.motion).transpose();
      const VectorXcd signal = u.index < elements
                                   ? VectorXcd(-q.array() / stretch.w.array().square())
                                   : VectorXcd(q.array() / (kJ * stretch.w.array()));
      return whiten_rows(system, plant.building.act.col(e), u.scale * signal);
    }
    case Kind::mass: {
      VectorXd direction = VectorXd::Zero(plant.equations());
      direction[u.index] = 1;
      return whiten_rows(system, direction,
                         u.scale * (plant.building.mass.row(u.index) * system.motion).transpose());
    }
    case Kind::gain:
      return whiten_axis(
          system, u.index,
          -u.scale / (1 + model.gain[u.index]) * system.motion.row(u.index).transpose());
    case Kind::clock:
      return whiten_axis(
          system, u.index,
          u.scale *
              (system.motion.row(u.index).transpose().array() * stretch.w.array() * kJ).matrix());
    case Kind::record_knob:
      if (static_cast<std::size_t>(u.record) != record)
        return VectorXd::Zero(system.residual.size());
      [[fallthrough]];
    case Kind::knob:
      break;
  }
  return knob_column(plant, model, stretch, record, system, u, ratio);
}

}  // namespace framewatch
