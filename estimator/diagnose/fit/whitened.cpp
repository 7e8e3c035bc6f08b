// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/whitened.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/fit/measured_deformation.h"
#include "estimator/diagnose/model/law_port.h"
#include "estimator/diagnose/model/linear_operation.h"
#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/diagnose/spectra/whiteners.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kArbitrary = 1e6;  ///< variance of an arbitrary signal, over that of noise
constexpr Index kMinNeighbors = 8;  ///< bins on either side over which the misfit is averaged

}  // namespace

Operations::Operations(const MatrixXd& mass, const MatrixXd& stiffness, const MatrixXd& damping,
                       std::vector<LinearOperation> additions, VectorXd w)
    : mass_(mass),
      stiffness_(stiffness),
      damping_(damping),
      additions_(std::move(additions)),
      w_(std::move(w)) {
  constexpr Index kMaxKept = 1'000'000;  // numbers
  const Index bins = w_.size();
  if (mass_.size() * bins > kMaxKept) return;
  for (Index b = 0; b < bins; ++b) kept_.push_back(made(b));
}

MatrixXcd Operations::times(const MatrixXcd& motion) const {
  return product(motion, false);
}

MatrixXcd Operations::adjoint_times(const MatrixXcd& forces) const {
  return product(forces, true);
}

MatrixXcd Operations::of_axis(Index axis) const {
  MatrixXcd out(equations(), w_.size());
  for (Index b = 0; b < out.cols(); ++b) {
    if (!kept_.empty() || !additions_.empty()) {
      out.col(b) = (*this)[static_cast<std::size_t>(b)].col(axis);
      continue;
    }
    out.col(b).real() = mass_.col(axis) - stiffness_.col(axis) / (w_[b] * w_[b]);
    out.col(b).imag() = damping_.col(axis) / -w_[b];
  }
  return out;
}

MatrixXcd Operations::made(Index bin) const {
  const double w = w_[bin];
  MatrixXcd out(mass_.rows(), mass_.cols());
  out.real() = mass_ - stiffness_ / (w * w);
  out.imag() = damping_ / -w;
  for (const LinearOperation& addition : additions_) addition.add_to(w, out);
  return out;
}

MatrixXcd Operations::product(const MatrixXcd& columns, bool adjoint) const {
  const Index bins = w_.size();
  // Real parts of all bins, then imaginary parts: one real product for each matrix.
  RowMatrix parts = RowMatrix::Zero(columns.rows(), padded(static_cast<int>(2 * bins)));
  parts.leftCols(bins) = columns.real();
  parts.middleCols(bins, bins) = columns.imag();
  const auto times_parts = [&](const MatrixXd& matrix) {
    RowMatrix out;
    multiply(adjoint ? RowMatrix(matrix.transpose()) : RowMatrix(matrix), parts, out);
    return out;
  };
  const RowMatrix inert = times_parts(mass_), elastic = times_parts(stiffness_),
                  viscous = times_parts(damping_);
  MatrixXcd out(inert.rows(), bins);
  for (Index b = 0; b < bins; ++b) {
    const double square = w_[b] * w_[b], w = adjoint ? -w_[b] : w_[b];
    out.col(b).real() = inert.col(b) - elastic.col(b) / square + viscous.col(bins + b) / w;
    out.col(b).imag() = inert.col(bins + b) - elastic.col(bins + b) / square - viscous.col(b) / w;
  }
  for (const LinearOperation& addition : additions_) addition.add_times(w_, columns, adjoint, out);
  return out;
}

VectorXd whiten_rows(const Whitened& s, const MatrixXcd& forces) {
  return s.weights->whitened(forces);
}

VectorXd whiten_rows(const Whitened& s, const VectorXd& direction, const VectorXcd& signal) {
  return s.weights->whitened(direction.cast<Complex>() * signal.transpose());
}

VectorXd whiten_axis(const Whitened& s, Index axis, const VectorXcd& signal) {
  return s.weights->whitened(s.operation.of_axis(axis) * signal.asDiagonal());
}

namespace {

/// Returns bin_noise() with the variance of clipped axes raised, so that their readings have no
/// weight.
VectorXd believed_noise(const Model& model, const RecordSegment& segment, Index bin) {
  VectorXd out = bin_noise(model, segment, bin);
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::clipped) out[e.place.channel] *= kArbitrary;
  return out;
}

/// Returns believed_noise() of every bin: axes x bins.
MatrixXd noise_of(const Model& model, const RecordSegment& segment) {
  MatrixXd out(model.gain.size(), segment.bins());
  for (Index b = 0; b < out.cols(); ++b) out.col(b) = believed_noise(model, segment, b);
  return out;
}

HiddenOscillator hidden_oscillator(const Plant& plant, const ModelEffect& e, const VectorXd& w) {
  HiddenOscillator out{node_direction(plant, e.place.story, e.place.frame), VectorXcd(w.size())};
  for (Index b = 0; b < w.size(); ++b) out.transmissibility[b] = transmissibility(e, w[b]);
  return out;
}

/// Returns for every bin which share of the residual is noise: less than 1 if the model does not
/// fit. rest: whitened residual.
VectorXd share_of_noise(const Plant& plant, const VectorXd& rest, Index bins) {
  if (rest.squaredNorm() <
      kNearNoise * static_cast<double>(plant.read_equations()) * static_cast<double>(bins))
    return VectorXd::Ones(bins);
  const Index around = std::max<Index>(kMinNeighbors, bins / 60);
  return local_misfit(plant, rest, bins, around).cwiseMax(1e-300).cwiseInverse().cwiseMin(1.0);
}

/// Returns the likeliest motion, docs/equations.md (34), for which the gradient is exact.
/// by_readings: D^H by_forces. share: of the residual that is noise, of every bin.
MatrixXcd likeliest_motion(const Plant& plant, const MatrixXd& noise, const Whitened& system,
                           const MatrixXcd& by_readings, const VectorXd& share) {
  MatrixXcd out = system.calibrated;
  const Index axes = plant.axis_count();
  for (Index b = 0; b < system.bins(); ++b)
    out.col(b).head(axes) -= share[b] * noise.col(b).cwiseProduct(by_readings.col(b).head(axes));
  return out;
}

/// Sets the motions that no axis reads so that the equations along them hold.
void follow_unread(const Plant& plant, const MatrixXcd& forces, const Operations& operation,
                   MatrixXcd& motion) {
  const Index hidden = plant.unread.cols(), axes = plant.axis_count();
  if (hidden == 0) return;
  const MatrixXcd along = plant.unread.transpose().cast<Complex>();
  for (Index b = 0; b < motion.cols(); ++b) {
    const MatrixXcd kept = along * operation[static_cast<std::size_t>(b)];
    const VectorXcd force = kept.leftCols(axes) * motion.col(b).head(axes) + along * forces.col(b);
    motion.col(b).tail(hidden) = -ComplexLu(kept.rightCols(hidden)).solve(force);
  }
}

/// Returns the model's weights, or null if they cannot be computed.
std::shared_ptr<const Weights> weights_of(const Plant& plant, const Model& model,
                                          const RecordSegment& segment, const MatrixXd& noise,
                                          const Operations& operations) {
  MatrixXd pushed;  // covariance of arbitrary forces
  std::vector<HiddenOscillator> hidden;
  for (const ModelEffect& e : model.effects) {
    if (e.form == LawForm::resonator) hidden.push_back(hidden_oscillator(plant, e, segment.w));
    if (e.form != LawForm::broadband) continue;
    const VectorXd at = node_direction(plant, e.place.story, e.place.frame);
    if (pushed.size() == 0) pushed = MatrixXd::Zero(plant.equations(), plant.equations());
    pushed += at * at.transpose() / at.squaredNorm();
  }
  const auto operation = [&](Index b) { return operations[static_cast<std::size_t>(b)]; };
  const bool all_read = plant.unread.cols() == 0;
  std::vector<Whitener> own =
      all_read ? whiteners(operation, noise, kArbitrary * pushed)
               : whiteners(operation, noise, kArbitrary * pushed, {plant.read, plant.unread});
  if (own.empty()) return nullptr;
  return std::make_shared<const Weights>(std::move(own), segment.w, std::move(hidden),
                                         all_read ? MatrixXd() : plant.read);
}

/// Sets everything that depends on the weights. weights: null: compute the model's weights.
void weigh(const Plant& plant, const Model& model, const RecordSegment& segment,
           std::shared_ptr<const Weights> weights, Whitened& out) {
  const MatrixXd noise = noise_of(model, segment);
  if (!weights) weights = weights_of(plant, model, segment, noise, out.operation);
  if (!weights) return;
  out.weights = std::move(weights);
  out.residual = out.weights->whitened(out.operation.times(out.calibrated) + out.forces);
  out.rest = out.weights->without_ends(out.residual);
  out.misfit = out.rest.squaredNorm();
  if (!std::isfinite(out.misfit)) return;
  out.by_forces = out.weights->turned_back(out.rest);
  out.by_readings = out.operation.adjoint_times(out.by_forces);
  out.motion = likeliest_motion(plant, noise, out, out.by_readings,
                                share_of_noise(plant, out.rest, out.bins()));
  follow_unread(plant, out.forces, out.operation, out.motion);
  out.good = true;
}

}  // namespace

Whitened whiten(const Plant& plant, const Model& model, const RecordSegment& segment,
                std::size_t record, Forcing forcing, const MatrixXcd& motion, int ratio) {
  std::optional<std::vector<LawTrack>> tracks =
      tracks_of(plant, model, segment, record, forcing, motion, ratio);
  return tracks ? whiten(plant, model, segment, record, std::move(*tracks), ratio) : Whitened{};
}

Whitened whiten(const Plant& plant, const Model& model, const RecordSegment& segment,
                std::size_t record, std::vector<LawTrack> tracks, int ratio,
                std::shared_ptr<const Weights> weights) {
  Whitened out;
  const Index n = plant.equations(), bins = segment.bins(), elements = plant.element_count();
  out.calibrated = MatrixXcd::Zero(plant.building.axes(), bins);
  out.calibrated.topRows(plant.axis_count()) = calibrated(model, segment);
  out.tracks = std::move(tracks);

  out.forces = MatrixXcd::Zero(n, bins);
  std::vector<LinearOperation> additions;
  std::size_t law = 0;
  MatrixXd stiffness = MatrixXd::Zero(n, plant.building.axes()),
           damping = stiffness;  // of the laws
  for (const ActiveLaw& active : active_laws(plant, model)) {
    const LawTrack& track = out.tracks[law++];
    if (!track.force.allFinite()) return out;
    const Equivalent& linear = out.linear.emplace_back(equivalent_of(track));
    const MatrixXd shape = active.port.act * active.port.sense;
    stiffness += linear.stiffness * shape;
    damping += linear.damping * shape;
    out.force.push_back(band_of(track.force, segment, ratio));
    out.forces +=
        active.port.act *
        beyond(linear, out.force.back(), band_of(track.d, segment, ratio), segment.w).transpose();
  }
  for (const ModelEffect& e : model.effects) {
    if (e.element_law() || e.form == LawForm::modal_damping || e.form == LawForm::broadband)
      continue;
    // An external force is on the other side of the equation.
    if (e.form == LawForm::harmonic)
      out.forces -= node_direction(plant, e.place.story, e.place.frame) *
                    harmonic_bins(e, segment, record).transpose();
    else
      additions.emplace_back(plant, model, e);
  }

  const MatrixXd& act = plant.building.act;
  const MatrixXd& sense = plant.building.sense;
  const MatrixXd mass =
      (1 + model.mass_change.array()).matrix().asDiagonal() * plant.building.mass + plant.push;
  stiffness += act * model.theta.head(elements).asDiagonal() * sense;
  damping += act * model.theta.tail(elements).asDiagonal() * sense;
  if (has_modal_damping(model)) damping += modal_damping(plant, model) * relative_motion(plant);
  out.operation = Operations(mass, stiffness, damping, std::move(additions), segment.w);
  follow_unread(plant, out.forces, out.operation, out.calibrated);
  weigh(plant, model, segment, std::move(weights), out);
  return out;
}

VectorXd local_misfit(const Plant& plant, const VectorXd& rest, Index bins, Index around) {
  const Index n = plant.equations();
  VectorXd level(bins), out(bins);
  for (Index b = 0; b < bins; ++b) level[b] = rest.segment(2 * n * b, 2 * n).squaredNorm();
  for (Index b = 0; b < bins; ++b) {
    const Index from = std::max<Index>(0, b - around), to = std::min(bins, b + around + 1);
    out[b] = level.segment(from, to - from).mean() / static_cast<double>(plant.read_equations());
  }
  return out;
}

void set_motion(const Plant& plant, const Model& model, const RecordSegment& segment,
                const VectorXd& rest, Whitened& system) {
  const MatrixXcd by_readings = system.operation.adjoint_times(system.weights->turned_back(rest));
  system.motion = likeliest_motion(plant, noise_of(model, segment), system, by_readings,
                                   share_of_noise(plant, rest, system.bins()));
  follow_unread(plant, system.forces, system.operation, system.motion);
}

Whitened with_own_weights(const Plant& plant, const Model& model, const RecordSegment& segment,
                          Whitened system) {
  system.good = false;
  weigh(plant, model, segment, nullptr, system);
  return system;
}

}  // namespace framewatch::estimator
