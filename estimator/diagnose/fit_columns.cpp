#include <cmath>

#include "estimator/diagnose/run_columns.h"
#include "estimator/structure/complex.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Kind = Unknown::Kind;

/// What one value of an effect changes, on the motion as it is.
VectorXd knob_column(const Plant& plant, const Model& model, const Stretch& stretch,
                     std::size_t record, const Whitened& system, const Unknown& unknown,
                     int ratio) {
  const auto at = static_cast<std::size_t>(unknown.index);
  const ModelEffect& e = model.effects[at];
  Model moved = model;
  set_value(moved, unknown, value_of(model, unknown) + 1);
  const ModelEffect& to = moved.effects[at];
  if (e.element_law()) {
    std::size_t law = 0;
    for (std::size_t i = 0; i < at; ++i) law += model.effects[i].element_law();
    const LawTrack& track = system.tracks[law];
    const VectorXd force =
        law_force(to.law(record), track.d, track.v, 1 / (stretch.rate_hz * ratio)) - track.force;
    return whiten_rows(system, plant.building.act.col(element_of(plant, e.place)),
                       band_of(force, stretch, ratio));
  }
  if (e.form == LawForm::harmonic)
    return whiten_rows(system, node_direction(plant, e.place.story, e.place.frame),
                       harmonic_bins(e, stretch, record) - harmonic_bins(to, stretch, record));
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
  return whiten_rows(system, change);
}

/// Columns of stiffnesses, dampings, masses, gains and clocks.
void put_linear_columns(const Plant& plant, const Model& model, const Stretch& stretch,
                        const Whitened& system, const std::vector<Unknown>& unknowns,
                        MatrixXd& out) {
  const Index n = plant.equations(), elements = plant.element_count();
  const MatrixXcd sensed = plant.building.sense * system.motion;
  const MatrixXcd inertia = plant.building.mass * system.motion;
  const MatrixXcd act = plant.building.act.cast<Complex>();
  for (Index b = 0; b < system.bins(); ++b) {
    const double w = stretch.w[b];
    const MatrixXcd& whitener = system.whitener[static_cast<std::size_t>(b)];
    const MatrixXcd of_elements = whitener * act;
    const MatrixXcd of_axes = whitener * system.operation[static_cast<std::size_t>(b)];
    const auto put = [&](Index u, const auto& direction, Complex signal) {
      const VectorXcd value = signal * direction;
      out.col(u).segment(2 * n * b, n) = value.real();
      out.col(u).segment(2 * n * b + n, n) = value.imag();
    };
    for (Index u = 0; u < out.cols(); ++u) {
      const Unknown& unknown = unknowns[static_cast<std::size_t>(u)];
      const Index i = unknown.index;
      switch (unknown.kind) {
        case Kind::theta: {
          const Index e = i % elements;
          put(u, of_elements.col(e),
              unknown.scale * sensed(e, b) * (i < elements ? Complex(-1 / (w * w)) : -kJ / w));
          break;
        }
        case Kind::mass:
          put(u, whitener.col(i), unknown.scale * inertia(i, b));
          break;
        case Kind::gain:
          put(u, of_axes.col(i), -unknown.scale / (1 + model.gain[i]) * system.motion(i, b));
          break;
        case Kind::clock:
          put(u, of_axes.col(i), unknown.scale * w * kJ * system.motion(i, b));
          break;
        case Kind::knob:
        case Kind::record_knob:
          break;
      }
    }
  }
}

}  // namespace

MatrixXd columns_of(const Plant& plant, const Model& model, const Stretch& stretch,
                    std::size_t record, const Whitened& system,
                    const std::vector<Unknown>& unknowns, int ratio, bool through_run) {
  MatrixXd out(system.residual.size(), static_cast<Index>(unknowns.size()));
  put_linear_columns(plant, model, stretch, system, unknowns, out);
  const bool runs = through_run && !system.tracks.empty() && !plant.prescribed;
  for (Index u = 0; u < out.cols(); ++u) {
    const Unknown& unknown = unknowns[static_cast<std::size_t>(u)];
    const bool knob = unknown.kind == Kind::knob || unknown.kind == Kind::record_knob;
    if (unknown.kind == Kind::record_knob && static_cast<std::size_t>(unknown.record) != record) {
      out.col(u).setZero();
      continue;
    }
    std::optional<VectorXd> run;
    if (runs && moves_run(plant, model, unknown))
      run = run_column(plant, model, stretch, record, system, unknown, ratio);
    const bool of_law =
        knob && model.effects[static_cast<std::size_t>(unknown.index)].element_law();
    if (knob && !(of_law && run))
      out.col(u) = knob_column(plant, model, stretch, record, system, unknown, ratio);
    if (of_law && run)
      out.col(u) = *run;
    else if (run)
      out.col(u) += *run;
  }
  return out;
}

}  // namespace framewatch
