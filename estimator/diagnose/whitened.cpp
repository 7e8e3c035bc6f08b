#include "estimator/diagnose/whitened.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

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
constexpr double kNotBelieved = 1e6;   ///< variance of what may be anything, over that of noise
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
  for (Index b = 0; b < forces.cols(); ++b)
    put(out, b, s.whitener[static_cast<std::size_t>(b)] * forces.col(b));
  return out;
}

VectorXd whiten_rows(const Whitened& s, const VectorXd& direction, const VectorXcd& signal) {
  VectorXd out(2 * direction.size() * signal.size());
  for (Index b = 0; b < signal.size(); ++b)
    put(out, b, s.whitener[static_cast<std::size_t>(b)] * (direction.cast<Complex>() * signal[b]));
  return out;
}

VectorXd whiten_axis(const Whitened& s, Index axis, const VectorXcd& signal) {
  const Index n = s.operation.empty() ? 0 : s.operation[0].rows();
  VectorXd out(2 * n * signal.size());
  for (Index b = 0; b < signal.size(); ++b) {
    const auto at = static_cast<std::size_t>(b);
    put(out, b, s.whitener[at] * (s.operation[at].col(axis) * signal[b]));
  }
  return out;
}

VectorXd bin_noise(const Model& model, const Stretch& stretch, Index bin) {
  VectorXd out = static_cast<double>(stretch.intervals()) * stretch.variance;
  for (Index a = 0; a < out.size(); ++a)
    if (stretch.is_displaced(a)) out[a] *= std::pow(stretch.w[bin], 4);
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::swapped) std::swap(out[e.place.channel], out[e.place.with_channel]);
  return out;
}

namespace {

/// The same, with axes whose reading is not believed.
VectorXd believed_noise(const Model& model, const Stretch& stretch, Index bin) {
  VectorXd out = bin_noise(model, stretch, bin);
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::clipped) out[e.place.channel] *= kNotBelieved;
  return out;
}

}  // namespace

Whitened whiten(const Plant& plant, const Model& model, const Stretch& stretch, std::size_t record,
                Forcing forcing, const MatrixXcd& motion, int ratio, const Whitened* weights) {
  Whitened out;
  const Index n = plant.equations(), bins = stretch.bins(), elements = plant.element_count();
  out.calibrated = calibrated(model, stretch);
  const MatrixXcd& driving = motion.size() > 0 ? motion : out.calibrated;

  std::vector<const ModelEffect*> laws;
  for (const ModelEffect& e : model.effects)
    if (e.element_law()) laws.push_back(&e);
  if (forcing == Forcing::simulated && !laws.empty() && !plant.prescribed) {
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
    const Equivalent& linear = out.linear.emplace_back(equivalent_of(track));
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

  MatrixXd pushed = MatrixXd::Zero(n, n);  // covariance of forces that may be anything
  for (const ModelEffect& effect : model.effects) {
    if (effect.form != LawForm::broadband) continue;
    const VectorXd at = node_direction(plant, effect.place.story, effect.place.frame);
    pushed += at * at.transpose() / at.squaredNorm();
  }
  const MatrixXd mass = (1 + model.mass_change.array()).matrix().asDiagonal() * plant.building.mass;
  const MatrixXd& act = plant.building.act;
  const MatrixXd& sense = plant.building.sense;
  out.operation.resize(static_cast<std::size_t>(bins));
  out.residual.resize(2 * n * bins);
  std::vector<const ModelEffect*> hidden;  // oscillators, whose motion does not end at rest either
  for (const ModelEffect& effect : model.effects)
    if (effect.form == LawForm::resonator) hidden.push_back(&effect);
  if (weights) {
    out.whitener = weights->whitener;
    out.ends = weights->ends;
    out.ends_normal = weights->ends_normal;
    out.ends_factor = weights->ends_factor;
  } else {
    out.whitener.resize(static_cast<std::size_t>(bins));
    out.ends.resize(2 * n * bins, kEndTerms * n + 2 * static_cast<Index>(hidden.size()));
  }
  const double middle = std::sqrt(stretch.w[0] * stretch.w[bins - 1]);
  VectorXcd e(n);
  for (Index b = 0; b < bins; ++b) {
    const double w = stretch.w[b];
    const VectorXd noise = believed_noise(model, stretch, b);
    MatrixXcd& d = out.operation[static_cast<std::size_t>(b)];
    d.resize(n, plant.axis_count());
    d.real() = mass + plant.push + act * (theta.head(elements) / -(w * w)).asDiagonal() * sense;
    d.imag() = act * (theta.tail(elements) / -w).asDiagonal() * sense;
    for (const ModelEffect& effect : model.effects)
      if (!effect.element_law()) d += linear_operation(plant, model, effect, w);
    MatrixXcd& end = out.whitener[static_cast<std::size_t>(b)];
    if (!weights) {
      MatrixXcd covariance = d * noise.asDiagonal() * d.adjoint();
      const double size = kNotBelieved * covariance.trace().real() / static_cast<double>(n);
      covariance += (size * pushed).cast<Complex>();
      const Eigen::LLT<MatrixXcd> llt(covariance);
      if (llt.info() != Eigen::Success) return out;
      end = MatrixXcd::Identity(n, n);
      llt.matrixL().solveInPlace(end);
    }
    e = d * out.calibrated.col(b) + forces.col(b);
    put(out.residual, b, end * e);
    if (weights) continue;
    const double r = w / middle;
    out.ends.block(2 * n * b, 0, n, n) = end.real() / (r * r);
    out.ends.block(2 * n * b + n, 0, n, n) = end.imag() / (r * r);
    out.ends.block(2 * n * b, n, n, n) = end.imag() / r;  // 1/(j r)
    out.ends.block(2 * n * b + n, n, n, n) = -end.real() / r;
    out.ends.block(2 * n * b, 2 * n, n, n) = end.real();
    out.ends.block(2 * n * b + n, 2 * n, n, n) = end.imag();
    out.ends.block(2 * n * b, 3 * n, n, n) = -end.imag() * r;
    out.ends.block(2 * n * b + n, 3 * n, n, n) = end.real() * r;
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      const ModelEffect& h = *hidden[i];
      const double wr = 2 * M_PI * h.knobs[1].plain();
      const Complex spring = wr * wr + 2.0 * h.knobs[2].plain() * wr * w * kJ;
      const VectorXcd at =
          end * (node_direction(plant, h.place.story, h.place.frame) * (spring / (spring - w * w)));
      const Index column = kEndTerms * n + 2 * static_cast<Index>(i);
      out.ends.block(2 * n * b, column, n, 1) = at.real();
      out.ends.block(2 * n * b + n, column, n, 1) = at.imag();
      out.ends.block(2 * n * b, column + 1, n, 1) = -at.imag() * r;
      out.ends.block(2 * n * b + n, column + 1, n, 1) = at.real() * r;
    }
  }
  if (!weights) {
    for (Index c = 0; c < out.ends.cols(); ++c)
      out.ends.col(c) /= std::max(out.ends.col(c).norm(), 1e-300);
    out.ends_normal = MatrixXd::Zero(out.ends.cols(), out.ends.cols());
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
    const VectorXd noise = believed_noise(model, stretch, b);
    out.motion.col(b) -= share * (noise.asDiagonal() *
                                  (out.operation[at].adjoint() * (out.whitener[at].adjoint() * r)));
  }
  out.good = true;
  return out;
}

}  // namespace framewatch
