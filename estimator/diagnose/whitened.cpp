#include "estimator/diagnose/whitened.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace framewatch {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
constexpr Complex kJ{0, 1};
constexpr Index kEndTerms = 4;
constexpr Index kLeastNeighbours = 8;  ///< bins either side over which the misfit is averaged

void put(VectorXd& rows, Index bin, const VectorXcd& values) {
  const Index n = values.size();
  rows.segment(2 * n * bin, n) = values.real();
  rows.segment(2 * n * bin + n, n) = values.imag();
}

/// Spectra of the axes without the errors that the model gives them.
MatrixXcd calibrated(const Model& model, const Stretch& stretch) {
  MatrixXcd out = stretch.spectrum;
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::swapped) out.row(e.place.channel).swap(out.row(e.place.with_channel));
  for (Index a = 0; a < out.rows(); ++a)
    for (Index b = 0; b < out.cols(); ++b)
      out(a, b) *= std::polar(1 / (1 + model.gain[a]), stretch.w[b] * model.clock_s[a]);
  const MatrixXcd straight = out;
  for (const ModelEffect& e : model.effects) {
    if (e.form != LawForm::misaligned) continue;
    const double angle = e.knobs[0].plain();
    out.row(e.place.channel) =
        (straight.row(e.place.channel) - std::sin(angle) * straight.row(e.place.with_channel)) /
        std::cos(angle);
  }
  return out;
}

struct Equivalent {
  double stiffness = 0, damping = 0;
};

/// The linear element nearest to a force.
Equivalent equivalent_of(const LawTrack& track) {
  const double dd = track.d.squaredNorm(), vv = track.v.squaredNorm(), dv = track.d.dot(track.v);
  const double fd = track.force.dot(track.d), fv = track.force.dot(track.v);
  const double det = dd * vv - dv * dv;
  if (!(det > 1e-9 * dd * vv)) return {};
  return {(fd * vv - fv * dv) / det, (fv * dd - fd * dv) / det};
}

}  // namespace

VectorXd whiten_rows(const Whitened& s, const MatrixXcd& forces) {
  VectorXd out(2 * forces.size());
  VectorXcd column(forces.rows());
  for (Index b = 0; b < forces.cols(); ++b) {
    column = forces.col(b);
    s.factor[static_cast<std::size_t>(b)].triangularView<Eigen::Lower>().solveInPlace(column);
    put(out, b, column);
  }
  return out;
}

VectorXd whiten_rows(const Whitened& s, const VectorXd& direction, const VectorXcd& signal) {
  VectorXd out(2 * direction.size() * signal.size());
  VectorXcd column(direction.size());
  for (Index b = 0; b < signal.size(); ++b) {
    column = direction.cast<Complex>() * signal[b];
    s.factor[static_cast<std::size_t>(b)].triangularView<Eigen::Lower>().solveInPlace(column);
    put(out, b, column);
  }
  return out;
}

VectorXd whiten_axis(const Whitened& s, Index axis, const VectorXcd& signal) {
  const Index n = s.operation.empty() ? 0 : s.operation[0].rows();
  VectorXd out(2 * n * signal.size());
  VectorXcd column(n);
  for (Index b = 0; b < signal.size(); ++b) {
    column = s.operation[static_cast<std::size_t>(b)].col(axis) * signal[b];
    s.factor[static_cast<std::size_t>(b)].triangularView<Eigen::Lower>().solveInPlace(column);
    put(out, b, column);
  }
  return out;
}

Whitened whiten(const Plant& plant, const Model& model, const Stretch& stretch, std::size_t record,
                Forcing forcing, const MatrixXcd& motion, int ratio, const Whitened* weights) {
  Whitened out;
  const Index n = plant.equations(), bins = stretch.bins(), elements = plant.element_count();
  out.calibrated = calibrated(model, stretch);
  const MatrixXcd& driving = motion.size() > 0 ? motion : out.calibrated;

  std::vector<const ModelEffect*> laws;
  for (const ModelEffect& e : model.effects)
    if (e.element_law()) laws.push_back(&e);
  if (forcing == Forcing::simulated && !laws.empty()) {
    FreeRun run = free_run(plant, model, stretch, record, ratio);
    if (!run.good) return out;
    out.tracks = std::move(run.tracks);
  } else {
    for (const ModelEffect* e : laws) {
      const VectorXcd q =
          (plant.building.sense.row(element_of(plant, e->place)) * driving).transpose();
      const VectorXcd d = -q.array() / stretch.w.array().square();
      const VectorXcd v = d.array() * stretch.w.array() * kJ;
      LawTrack track{signal_of(d, stretch, ratio), signal_of(v, stretch, ratio), {}};
      track.force = law_force(e->law(record), track.d, track.v, 1 / (stretch.rate_hz * ratio));
      out.tracks.push_back(std::move(track));
    }
  }

  VectorXd theta = model.theta;
  MatrixXcd forces = MatrixXcd::Zero(n, bins);
  for (std::size_t l = 0; l < laws.size(); ++l) {
    const LawTrack& track = out.tracks[l];
    if (!track.force.allFinite()) return out;
    const Equivalent linear = equivalent_of(track);
    const int element = element_of(plant, laws[l]->place);
    theta[element] += linear.stiffness;
    theta[element + elements] += linear.damping;
    out.force.push_back(band_of(track.force, stretch, ratio));
    const VectorXcd d = band_of(track.d, stretch, ratio);
    const VectorXcd beyond =
        out.force.back().array() -
        d.array() * (linear.stiffness + kJ * linear.damping * stretch.w.array());
    forces += plant.building.act.col(element) * beyond.transpose();
  }
  for (const ModelEffect& e : model.effects) {
    if (e.form != LawForm::harmonic) continue;
    // A force from outside stands on the other side of the equation.
    const double hz = e.knobs[0].plain();
    VectorXd signal(stretch.intervals());
    for (Index i = 0; i < signal.size(); ++i) {
      const double t = static_cast<double>(i) / stretch.rate_hz, phase = 2 * M_PI * hz * t;
      const std::vector<Knob>& r = e.record_knobs[record];
      signal[i] =
          t < e.onset_s[record] ? 0 : r[0].value * std::cos(phase) + r[1].value * std::sin(phase);
    }
    forces -= node_direction(plant, e.place.story, e.place.frame) *
              band_of(signal, stretch, 1).transpose();
  }

  const VectorXd noise = static_cast<double>(stretch.intervals()) * stretch.variance;
  const MatrixXd mass = (1 + model.mass_change.array()).matrix().asDiagonal() * plant.building.mass;
  const MatrixXd& act = plant.building.act;
  const MatrixXd& sense = plant.building.sense;
  out.operation.resize(static_cast<std::size_t>(bins));
  out.residual.resize(2 * n * bins);
  if (weights) {
    out.factor = weights->factor;
    out.ends = weights->ends;
    out.ends_normal = weights->ends_normal;
    out.ends_factor = weights->ends_factor;
  } else {
    out.factor.resize(static_cast<std::size_t>(bins));
    out.ends.resize(2 * n * bins, kEndTerms * n);
  }
  const double middle = std::sqrt(stretch.w[0] * stretch.w[bins - 1]);
  VectorXcd e(n);
  MatrixXcd end(n, n);
  for (Index b = 0; b < bins; ++b) {
    const double w = stretch.w[b];
    MatrixXcd& d = out.operation[static_cast<std::size_t>(b)];
    d.resize(n, plant.axis_count());
    d.real() = mass + act * (theta.head(elements) / -(w * w)).asDiagonal() * sense;
    d.imag() = act * (theta.tail(elements) / -w).asDiagonal() * sense;
    for (const ModelEffect& effect : model.effects)
      if (!effect.element_law()) d += linear_operation(plant, model, effect, w);
    MatrixXcd& l = out.factor[static_cast<std::size_t>(b)];
    if (!weights) {
      const Eigen::LLT<MatrixXcd> llt(d * noise.asDiagonal() * d.adjoint());
      if (llt.info() != Eigen::Success) return out;
      l = llt.matrixL();
    }
    e = d * out.calibrated.col(b) + forces.col(b);
    l.triangularView<Eigen::Lower>().solveInPlace(e);
    put(out.residual, b, e);
    if (weights) continue;
    end.setIdentity();
    l.triangularView<Eigen::Lower>().solveInPlace(end);
    const double r = w / middle;
    out.ends.block(2 * n * b, 0, n, n) = end.real() / (r * r);
    out.ends.block(2 * n * b + n, 0, n, n) = end.imag() / (r * r);
    out.ends.block(2 * n * b, n, n, n) = end.imag() / r;  // 1/(j r)
    out.ends.block(2 * n * b + n, n, n, n) = -end.real() / r;
    out.ends.block(2 * n * b, 2 * n, n, n) = end.real();
    out.ends.block(2 * n * b + n, 2 * n, n, n) = end.imag();
    out.ends.block(2 * n * b, 3 * n, n, n) = -end.imag() * r;
    out.ends.block(2 * n * b + n, 3 * n, n, n) = end.real() * r;
  }
  if (!weights) {
    for (Index c = 0; c < out.ends.cols(); ++c)
      out.ends.col(c) /= std::max(out.ends.col(c).norm(), 1e-300);
    out.ends_normal = MatrixXd::Zero(kEndTerms * n, kEndTerms * n);
    out.ends_normal.selfadjointView<Eigen::Lower>().rankUpdate(out.ends.transpose());
    out.ends_normal = out.ends_normal.selfadjointView<Eigen::Lower>();
    out.ends_normal.diagonal().array() += 1e-12;
    out.ends_factor.compute(out.ends_normal);
  }
  out.rest = out.residual - out.ends * out.ends_factor.solve(out.ends.transpose() * out.residual);
  out.misfit = out.rest.squaredNorm();
  if (!std::isfinite(out.misfit)) return out;

  // Motion with the part of the sensors' noise taken off that the equations show, less of it where
  // the model does not fit.
  out.motion = out.calibrated;
  VectorXd level(bins);
  for (Index b = 0; b < bins; ++b) level[b] = out.rest.segment(2 * n * b, 2 * n).squaredNorm();
  const Index around = std::max<Index>(kLeastNeighbours, bins / 60);
  for (Index b = 0; b < bins; ++b) {
    const Index from = std::max<Index>(0, b - around), to = std::min(bins, b + around + 1);
    const double local = level.segment(from, to - from).mean() / static_cast<double>(n);
    const double share = std::min(1.0, 1 / std::max(local, 1e-300));
    VectorXcd r(n);
    r.real() = out.rest.segment(2 * n * b, n);
    r.imag() = out.rest.segment(2 * n * b + n, n);
    const std::size_t at = static_cast<std::size_t>(b);
    out.factor[at].triangularView<Eigen::Lower>().adjoint().solveInPlace(r);
    out.motion.col(b) -= share * (noise.asDiagonal() * (out.operation[at].adjoint() * r));
  }
  out.good = true;
  return out;
}

}  // namespace framewatch
