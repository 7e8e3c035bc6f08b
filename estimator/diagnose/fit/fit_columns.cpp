#include "estimator/diagnose/fit/fit_columns.h"

#include <cmath>

#include "estimator/diagnose/fit/run_columns.h"
#include "estimator/diagnose/model/linear_operation.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Kind = Unknown::Kind;

/// Derivative by one parameter of an effect, the motion held.
VectorXd parameter_column(const Plant& plant, const Model& model, const RecordSegment& segment,
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
        law_force(to.law(record), track.d, track.v, 1 / (segment.rate_hz * ratio)) - track.force;
    return whiten_rows(system, plant.building.act.col(element_of(plant, e.place)),
                       band_of(force, segment, ratio));
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
  MatrixXcd change(plant.equations(), system.bins());
  for (Index b = 0; b < system.bins(); ++b)
    change.col(b) = (then.at(segment.w[b]) - from.at(segment.w[b])) * system.motion.col(b);
  return whiten_rows(system, change);
}

/// Derivative by an unknown of the linear building or of an axis: a direction times a spectrum.
struct Acting {
  Index direction = -1;  ///< of an element, then of an axis, then of a coordinate's mass
  VectorXcd size;
};

Acting acting(const Plant& plant, const Model& model, const RecordSegment& segment,
              const Whitened& system, const Unknown& unknown) {
  const Index i = unknown.index, elements = plant.element_count(), axes = plant.axis_count();
  const auto w = segment.w.array();
  const auto motion_of = [&](const MatrixXd& rows, Index row) {
    return (unknown.scale * rows.row(row) * system.motion).transpose().array().eval();
  };
  switch (unknown.kind) {
    case Kind::theta: {
      const Eigen::ArrayXcd d = motion_of(plant.building.sense, i % elements) / w.square();
      if (i < elements) return {i, -d};
      return {i - elements, -kJ * w * d};
    }
    case Kind::gain:
      return {elements + i,
              -unknown.scale / (1 + model.gain[i]) * system.motion.row(i).transpose()};
    case Kind::clock:
      return {elements + i,
              (unknown.scale * kJ * w * system.motion.row(i).transpose().array()).matrix()};
    case Kind::mass:
      return {elements + axes + i, motion_of(plant.building.mass, i).matrix()};
    case Kind::parameter:
    case Kind::record_parameter:
      return {};
  }
  return {};
}

/// Sets the columns of stiffnesses, dampings, masses, gains and clocks; other columns are zero.
void set_linear_columns(const Plant& plant, const Model& model, const RecordSegment& segment,
                        const Whitened& system, const std::vector<Unknown>& unknowns,
                        RowMatrix& out) {
  const Index n = plant.equations(), elements = plant.element_count(), axes = plant.axis_count();
  const auto count = static_cast<Index>(unknowns.size());
  std::vector<Index> direction(unknowns.size(), 0);
  MatrixXd re = MatrixXd::Zero(count, system.bins()), im = re;  // of the sizes
  for (Index u = 0; u < count; ++u) {
    const Acting one = acting(plant, model, segment, system, unknowns[static_cast<std::size_t>(u)]);
    if (one.direction < 0) continue;
    direction[static_cast<std::size_t>(u)] = one.direction;
    re.row(u) = one.size.real().transpose();
    im.row(u) = one.size.imag().transpose();
  }
  // Columns: elements, axes, coordinates. Rows: real parts of the forces, then imaginary parts with
  // opposite sign.
  RowMatrix acting_along = RowMatrix::Zero(2 * n, padded(static_cast<int>(elements + axes + n)));
  acting_along.topLeftCorner(n, elements) = plant.building.act;
  acting_along.block(0, elements + axes, n, n).setIdentity();
  RowMatrix forces, whitened;
  for (Index b = 0; b < system.bins(); ++b) {
    const MatrixXcd& operation = system.operation[static_cast<std::size_t>(b)];
    acting_along.block(0, elements, n, axes) = operation.real();
    acting_along.block(n, elements, n, axes) = -operation.imag();
    system.weights->put_unit_forces(b, false, forces);
    multiply(forces, acting_along, whitened);
    for (Index i = 0; i < n; ++i) {
      const double *x = &whitened(i, 0), *y = &whitened(n + i, 0);
      double *real = &out(2 * n * b + i, 0), *imag = &out(2 * n * b + n + i, 0);
      const double *a = re.col(b).data(), *c = im.col(b).data();
      for (Index u = 0; u < count; ++u) {
        const Index k = direction[static_cast<std::size_t>(u)];
        real[u] = x[k] * a[u] - y[k] * c[u];
        imag[u] = x[k] * c[u] + y[k] * a[u];
      }
    }
  }
}

}  // namespace

RowMatrix columns_of(const Plant& plant, const Model& model, const RecordSegment& segment,
                     std::size_t record, const Whitened& system,
                     const std::vector<Unknown>& unknowns, int ratio, bool through_run) {
  RowMatrix out(system.residual.size(), static_cast<Index>(unknowns.size()));
  set_linear_columns(plant, model, segment, system, unknowns, out);
  const bool runs = through_run && !system.tracks.empty() && !plant.prescribed;
  for (Index u = 0; u < out.cols(); ++u) {
    const Unknown& unknown = unknowns[static_cast<std::size_t>(u)];
    const bool parameter =
        unknown.kind == Kind::parameter || unknown.kind == Kind::record_parameter;
    if (unknown.kind == Kind::record_parameter &&
        static_cast<std::size_t>(unknown.record) != record) {
      out.col(u).setZero();
      continue;
    }
    std::optional<VectorXd> run;
    if (runs && moves_run(plant, model, unknown))
      run = run_column(plant, model, segment, record, system, unknown, ratio);
    const bool of_law =
        parameter && model.effects[static_cast<std::size_t>(unknown.index)].element_law();
    if (parameter && !(of_law && run))
      out.col(u) = parameter_column(plant, model, segment, record, system, unknown, ratio);
    if (of_law && run)
      out.col(u) = *run;
    else if (run)
      out.col(u) += *run;
  }
  return out;
}

}  // namespace framewatch::estimator
