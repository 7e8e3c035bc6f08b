// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/fit_columns.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "estimator/diagnose/model/law_port.h"
#include "estimator/diagnose/model/linear_operation.h"
#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Kind = Unknown::Kind;

constexpr double kChange = 1e-3;  ///< of a stiffness, for its derivative
/// Returns true if a stiffness is at the law or next to it. In a large building others move the run
/// too little for the cost of a run.
bool is_near(const EffectPlace& law, int story, int frame) {
  return law.frame == frame && std::abs(law.story - story) <= 1;
}

/// Returns the free run with an unknown changed. Keeps the modes of a large building.
FreeRun changed_run(const Plant& plant, const Model& model, const RecordSegment& segment,
                    std::size_t record, const Unknown& unknown, double change, int ratio,
                    RunCache* cache) {
  if (plant.is_large() && unknown.kind == Kind::theta) {
    std::vector<SmallSpring> springs{{unknown.index, change * unknown.scale}};
    for (const auto& [index, scale] : unknown.tied) springs.push_back({index, change * scale});
    return free_run(plant, model, segment, record, ratio, cache, springs);
  }
  Model moved = model;
  set_value(moved, unknown, value_of(model, unknown) + change);
  return free_run(plant, moved, segment, record, ratio, cache);
}

/// Returns the derivative by one parameter of an effect, with the motion held.
VectorXd parameter_column(const Plant& plant, const Model& model, const RecordSegment& segment,
                          std::size_t record, const Whitened& system, const Unknown& unknown,
                          int ratio) {
  const auto at = static_cast<std::size_t>(unknown.index);
  const ModelEffect& e = model.effects[at];
  Model moved = model;
  set_value(moved, unknown, value_of(model, unknown) + 1);
  const ModelEffect& to = moved.effects[at];
  if (e.element_law()) {
    MatrixXcd forces = MatrixXcd::Zero(plant.equations(), system.bins());
    const std::vector<ActiveLaw> laws = active_laws(plant, model);
    for (std::size_t law = 0; law < laws.size(); ++law) {
      if (laws[law].effect != at) continue;
      const LawTrack& track = system.tracks[law];
      const VectorXd force = law_force(law_at(moved, laws[law], record), track.d, track.v,
                                       1 / (segment.rate_hz * ratio)) -
                             track.force;
      forces += laws[law].port.act * band_of(force, segment, ratio).transpose();
    }
    return whiten_rows(system, forces);
  }
  if (e.form == LawForm::harmonic)
    return whiten_rows(system, node_direction(plant, e.place.story, e.place.frame),
                       harmonic_bins(e, segment, record) - harmonic_bins(to, segment, record));
  if (e.form == LawForm::misaligned) {
    const double a = e.parameters[0].plain(), b = to.parameters[0].plain();
    const VectorXcd own = system.calibrated.row(e.place.channel).transpose();
    const VectorXcd other = system.calibrated.row(e.place.with_channel).transpose();
    const VectorXcd raw = own * std::cos(a) + std::sin(a) * other;
    return whiten_axis(system, e.place.channel, (raw - std::sin(b) * other) / std::cos(b) - own);
  }
  const LinearOperation from(plant, model, e), then(plant, moved, to);
  MatrixXcd change = MatrixXcd::Zero(plant.equations(), system.bins()), before = change;
  then.add_times(segment.w, system.motion, false, change);
  from.add_times(segment.w, system.motion, false, before);
  change -= before;
  return whiten_rows(system, change);
}

/// Motions on which the linear building's unknowns act: bins x elements, bins x coordinates, bins x
/// axes.
struct Motions {
  MatrixXcd deformation, inertia, readings;
};

Motions motions_of(const Plant& plant, const RecordSegment& segment, const Whitened& system) {
  const MatrixXd real = system.motion.real().transpose(),
                 imaginary = system.motion.imag().transpose();
  const auto seen = [&](const MatrixXd& rows) {
    MatrixXcd out(real.rows(), rows.rows());
    out.real().noalias() = real * rows.transpose();
    out.imag().noalias() = imaginary * rows.transpose();
    return out;
  };
  Motions out{seen(plant.building.sense), seen(plant.building.mass), system.motion.transpose()};
  out.deformation.array().colwise() /= -segment.w.array().square().cast<Complex>();
  return out;
}

/// Derivative by an unknown of the linear building or of an axis: a direction times a spectrum.
struct Acting {
  Index direction = -1;  ///< of an element, then of an axis, then of a coordinate's mass
  VectorXcd size;
};

Acting acting(const Plant& plant, const Model& model, const RecordSegment& segment,
              const Motions& motions, const Unknown& unknown) {
  const Index i = unknown.index, elements = plant.element_count(), axes = plant.axis_count();
  const Eigen::ArrayXcd rate = kJ * unknown.scale * segment.w.array();
  switch (unknown.kind) {
    case Kind::theta:
      if (i < elements) return {i, unknown.scale * motions.deformation.col(i)};
      return {i - elements, (rate * motions.deformation.col(i - elements).array()).matrix()};
    case Kind::gain:
      return {elements + i, -unknown.scale / (1 + model.gain[i]) * motions.readings.col(i)};
    case Kind::clock:
      return {elements + i, (rate * motions.readings.col(i).array()).matrix()};
    case Kind::mass:
      return {elements + axes + i, unknown.scale * motions.inertia.col(i)};
    case Kind::parameter:
    case Kind::record_parameter:
      return {};
  }
  return {};
}

/// Returns such a derivative as whitened rows.
VectorXd along(const Plant& plant, const Whitened& system, const Acting& one) {
  const Index elements = plant.element_count(), axes = plant.axis_count();
  if (one.direction >= elements && one.direction < elements + axes)
    return whiten_axis(system, one.direction - elements, one.size);
  const VectorXd direction =
      one.direction < elements
          ? VectorXd(plant.building.act.col(one.direction))
          : VectorXd(VectorXd::Unit(plant.equations(), one.direction - elements - axes));
  return whiten_rows(system, direction, one.size);
}

/// Returns the derivative by the shared factor of a group of stories.
VectorXd along_tied(const Plant& plant, const Model& model, const RecordSegment& segment,
                    const Whitened& system, const Motions& motions, const Unknown& unknown,
                    const Acting& first) {
  MatrixXcd forces = MatrixXcd::Zero(plant.equations(), system.bins());
  const auto add = [&](const Acting& one) {
    for (Index i = 0; i < forces.rows(); ++i)
      if (const double share = plant.building.act(i, one.direction); share != 0)
        forces.row(i) += share * one.size.transpose();
  };
  add(first);
  for (const auto& [index, scale] : unknown.tied) {
    Unknown one{unknown.kind, index};
    one.scale = scale;
    add(acting(plant, model, segment, motions, one));
  }
  return whiten_rows(system, forces);
}

}  // namespace

bool moves_run(const Plant& plant, const Model& model, const Unknown& unknown) {
  if (unknown.kind == Kind::parameter || unknown.kind == Kind::record_parameter) return true;
  const Structure& s = plant.structure;
  int frame = -1, story = 0;  // -1: all directions
  if (unknown.kind == Kind::theta) {
    if (unknown.index >= plant.element_count()) return false;
    frame = plant.table[unknown.index].frame;
    if (frame < 0) return false;
    story = plant.table[unknown.index].story;
  } else if (unknown.kind == Kind::mass && !plant.is_large()) {
    if (plant.equations() == s.degrees_of_freedom()) {
      frame = unknown.index % s.frames();
      story = unknown.index / s.frames() + 1;
    }
  } else {
    return false;
  }
  return std::any_of(model.effects.begin(), model.effects.end(), [&](const ModelEffect& e) {
    if (plant.is_large() && frame >= 0) return e.element_law() && is_near(e.place, story, frame);
    return e.element_law() &&
           (frame < 0 || e.place.kind == PlaceKind::panel ||
            (e.place.frame < 0 ? e.place.direction : s.direction(e.place.frame)) ==
                s.direction(frame));
  });
}

std::optional<VectorXd> run_column(const Plant& plant, const Model& model,
                                   const RecordSegment& segment, std::size_t record,
                                   const Whitened& system, const Unknown& unknown, int ratio,
                                   RunCache* cache) {
  const double change = unknown.kind == Kind::theta ? kChange : 1.0;
  const FreeRun run = changed_run(plant, model, segment, record, unknown, change, ratio, cache);
  if (!run.good) return std::nullopt;
  Eigen::MatrixXcd forces = Eigen::MatrixXcd::Zero(plant.equations(), system.bins());
  std::size_t law = 0;
  for (const ActiveLaw& active : active_laws(plant, model)) {
    const LawTrack &from = system.tracks[law], &to = run.tracks[law];
    const VectorXcd force = band_of((to.force - from.force) / change, segment, ratio);
    const VectorXcd d = band_of((to.d - from.d) / change, segment, ratio);
    forces += active.port.act * beyond(system.linear[law], force, d, segment.w).transpose();
    ++law;
  }
  return whiten_rows(system, forces);
}

Columns columns_of(const Plant& plant, const Model& model, const RecordSegment& segment,
                   std::size_t record, const Whitened& system, const std::vector<Unknown>& unknowns,
                   int ratio, bool through_run, RunCache* cache) {
  Columns out;
  out.size = MatrixXcd::Zero(system.bins(), static_cast<Index>(unknowns.size()));
  std::vector<VectorXd> effects;
  const Motions motions = motions_of(plant, segment, system);
  const bool runs = through_run && !system.tracks.empty() && !plant.prescribed;
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const Unknown& unknown = unknowns[u];
    const bool parameter =
        unknown.kind == Kind::parameter || unknown.kind == Kind::record_parameter;
    const bool elsewhere = unknown.kind == Kind::record_parameter &&
                           static_cast<std::size_t>(unknown.record) != record;
    std::optional<VectorXd> run;
    if (runs && !elsewhere && moves_run(plant, model, unknown))
      run = run_column(plant, model, segment, record, system, unknown, ratio, cache);
    Acting one;
    if (!parameter) one = acting(plant, model, segment, motions, unknown);
    const bool own_rows = parameter || run || !unknown.tied.empty();
    out.direction.push_back(own_rows ? -1 : one.direction);
    out.row.push_back(-1);
    if (!own_rows || !unknown.tied.empty()) out.size.col(static_cast<Index>(u)) = one.size;
    if (out.direction.back() >= 0) continue;
    out.row.back() = static_cast<Index>(effects.size());
    const bool of_law =
        parameter && model.effects[static_cast<std::size_t>(unknown.index)].element_law();
    VectorXd column = VectorXd::Zero(system.residual.size());
    if (!parameter)
      column = unknown.tied.empty()
                   ? along(plant, system, one)
                   : along_tied(plant, model, segment, system, motions, unknown, one);
    else if (!elsewhere && !(of_law && run))
      column = parameter_column(plant, model, segment, record, system, unknown, ratio);
    if (run) column += *run;
    effects.push_back(std::move(column));
  }
  out.effects.resize(system.residual.size(), static_cast<Index>(effects.size()));
  for (std::size_t i = 0; i < effects.size(); ++i)
    out.effects.col(static_cast<Index>(i)) = effects[i];
  return out;
}

VectorXd whole_column(const Plant& plant, const Whitened& system, const Columns& columns,
                      Index unknown) {
  const auto at = static_cast<std::size_t>(unknown);
  if (columns.direction[at] < 0) return columns.effects.col(columns.row[at]);
  return along(plant, system, {columns.direction[at], columns.size.col(unknown)});
}

}  // namespace framewatch::estimator
