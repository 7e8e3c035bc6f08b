// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/gap.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "estimator/diagnose/fit/measured_deformation.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

double mean_of(double Gap::*value, const std::vector<Gap>& gaps, std::size_t from) {
  double sum = 0;
  for (std::size_t r = from; r < gaps.size(); ++r) sum += gaps[r].*value;
  return gaps.size() > from ? sum / static_cast<double>(gaps.size() - from) : 0;
}

/// Subtracts from e the part that arbitrary forces explain, estimated with the noise covariance.
void subtract_forces(const MatrixXcd& directions, const MatrixXcd& covariance, VectorXcd& e) {
  const ComplexCholesky factor(covariance);
  if (!factor.good()) return;
  const MatrixXcd u = factor.whitened(directions);
  const VectorXcd white = factor.whitened(e);
  const VectorXcd force = solve_ldlt(u.adjoint() * u, u.adjoint() * white);
  e -= directions * force;
}

/// Returns the reading of an axis above the base as a row over the coordinates.
Eigen::RowVectorXd reading_of(const Plant& plant, const SensorAxis& axis) {
  const std::vector<double> weights = frame_weights(plant.structure, axis);
  return Eigen::Map<const Eigen::RowVectorXd>(weights.data(), plant.structure.frames()) *
         plant.constraint.middleRows(plant.structure.dof(axis.story, 0), plant.structure.frames());
}

/// Sets the difference of a clipped axis: clips the simulated reading like the measured one.
void clip_difference(const RecordSegment& segment, const VectorXcd& measured, Index axis,
                     MatrixXcd& difference) {
  const Eigen::VectorXd reading = signal_of(measured, segment, 1);
  const Eigen::VectorXd simulated =
      signal_of(VectorXcd(measured - difference.row(axis).transpose()), segment, 1);
  const Eigen::VectorXd raw = segment.accel.col(axis).head(reading.size());
  const double level = 0.5 * (raw.maxCoeff() - raw.minCoeff());
  // Outside the band the simulated reading is assumed equal to the measured one.
  const Eigen::VectorXd outside = raw - reading;
  const Eigen::VectorXd cut = (simulated + outside).cwiseMax(-level).cwiseMin(level) - outside;
  difference.row(axis) = band_of(reading - cut, segment, 1).transpose();
}

/// Returns the rms of a signal in the band, mean over `axes`. power: sum of |spectrum|^2 over bins
/// and axes.
double rms_of(double power, Index axes, const RecordSegment& segment) {
  const double intervals = static_cast<double>(segment.intervals());
  return std::sqrt(2 * power / static_cast<double>(std::max<Index>(1, axes))) / intervals;
}

/// Returns the gap of the force if a component's motion is prescribed and the force measured.
Gap force_gap(const Plant& plant, const Model& model, const RecordSegment& segment,
              const Whitened& system) {
  const Index n = plant.equations(), axes = plant.axis_count(), bins = system.bins();
  Gap out;
  out.difference = MatrixXcd::Zero(axes, bins);
  out.noise = MatrixXd::Zero(axes, bins);
  out.axis = out.floor = VectorXd::Zero(axes);
  double error = 0, noise = 0, power = 0;
  Index axis = 0;
  while (axis + 1 < axes && !plant.is_force(axis)) ++axis;
  for (Index b = 0; b < bins; ++b) {
    const auto at = static_cast<std::size_t>(b);
    VectorXcd e = system.weights->forces_of(b, rows_of_bin(system.rest, b, n));
    out.difference(axis, b) = plant.push.col(axis).cast<Complex>().dot(e);
    const VectorXcd row = system.operation[at].adjoint() * plant.push.col(axis).cast<Complex>();
    error += std::norm(out.difference(axis, b));
    out.noise(axis, b) = row.cwiseAbs2().dot(bin_noise(model, segment, b));
    noise += out.noise(axis, b);
    power += std::norm(system.calibrated(axis, b));
  }
  out.axis[axis] = out.overall = out.worst = std::sqrt(error / std::max(power, 1e-300));
  out.floor[axis] = out.overall_floor = std::sqrt(noise / std::max(power, 1e-300));
  out.worst_axis = static_cast<int>(axis);
  out.measured_rms = rms_of(power, 1, segment);
  return out;
}

}  // namespace

bool is_output(const Plant& plant, Index axis) {
  return plant.prescribed ? plant.is_force(axis) : !plant.is_input(axis);
}

std::vector<RecordSegment> with_model_error(const Plant& plant,
                                            const std::vector<RecordSegment>& segments,
                                            double share) {
  std::vector<RecordSegment> out = segments;
  for (RecordSegment& s : out) {
    double power = 0;
    Index outputs = 0;
    for (Index a = 0; a < plant.axis_count(); ++a) {
      if (!is_output(plant, a)) continue;
      ++outputs;
      for (Index b = 0; b < s.bins(); ++b)
        power += std::norm(s.spectrum(a, b)) / (s.is_displaced(a) ? std::pow(s.w[b], 4) : 1.0);
    }
    const auto numbers = static_cast<double>(std::max<Index>(1, outputs * s.bins()));
    const double variance =
        share * share * power / (numbers * static_cast<double>(std::max<Index>(1, s.intervals())));
    const double noise = s.variance.sum();
    for (Index a = 0; a < plant.axis_count(); ++a)
      if (is_output(plant, a)) s.variance[a] += variance;
    s.corner_hz *= noise / std::max(s.variance.sum(), 1e-300);  // the model's error is white
  }
  return out;
}

Gap gap_of(const Plant& plant, const Model& model, const RecordSegment& segment,
           const Whitened& system) {
  const Index n = plant.equations(), axes = plant.axis_count(), bins = system.bins();
  const MatrixXd back = plant.motion.transpose() * inverse(plant.motion * plant.motion.transpose());
  std::vector<Index> bases;
  MatrixXd seen = MatrixXd::Zero(axes, n);  // motion of the coordinates -> axes
  VectorXd is_base = VectorXd::Zero(axes);
  for (Index a = 0; a < axes; ++a) {
    const SensorAxis& axis = plant.axes[static_cast<std::size_t>(a)];
    if (plant.is_input(a)) {
      is_base[a] = 1;
      bases.push_back(a);
    } else {
      seen.row(a) = reading_of(plant, axis);
    }
  }
  if (plant.prescribed) return force_gap(plant, model, segment, system);
  Gap out;
  out.difference = MatrixXcd::Zero(axes, bins);
  out.noise = MatrixXd::Zero(axes, bins);
  VectorXd noise = VectorXd::Zero(axes), power = VectorXd::Zero(axes), error = noise;
  MatrixXcd pushed(n, 0);
  for (const ModelEffect& effect : model.effects)
    if (effect.form == LawForm::broadband) {
      pushed.conservativeResize(n, pushed.cols() + 1);
      pushed.rightCols(1) =
          node_direction(plant, effect.place.story, effect.place.frame).cast<Complex>();
    }
  for (Index b = 0; b < bins; ++b) {
    const auto at = static_cast<std::size_t>(b);
    const VectorXd variance = bin_noise(model, segment, b);
    VectorXcd e = system.weights->forces_of(b, rows_of_bin(system.rest, b, n));
    if (pushed.cols() > 0)
      subtract_forces(pushed,
                      system.operation[at].leftCols(axes) * variance.asDiagonal() *
                          system.operation[at].leftCols(axes).adjoint(),
                      e);
    const MatrixXcd operation = system.operation[at];
    const MatrixXcd own = operation * back.cast<Complex>();
    const ComplexLu solver(own);
    const VectorXcd difference = solver.solve(e);
    const MatrixXcd from_base = solver.solve(MatrixXcd(operation(Eigen::all, bases)));
    out.difference.col(b) = seen.cast<Complex>() * difference;
    const MatrixXcd carried = seen.cast<Complex>() * from_base;
    // The gap of an axis that measures displacement is one of displacement.
    VectorXd square = (1 - is_base.array()).matrix();
    for (Index a = 0; a < axes; ++a)
      if (segment.is_displaced(a)) square[a] *= std::pow(segment.w[b], -4);
    out.difference.col(b).array() *= square.array().sqrt();
    out.noise.col(b) = square.cwiseProduct(carried.cwiseAbs2() * variance(bases) + variance);
    noise += out.noise.col(b);
    power += square.cwiseProduct(system.calibrated.col(b).head(axes).cwiseAbs2());
  }
  for (const ModelEffect& effect : model.effects)
    if (effect.form == LawForm::clipped)
      clip_difference(segment, system.calibrated.row(effect.place.channel).transpose(),
                      effect.place.channel, out.difference);
  error = out.difference.rowwise().squaredNorm();
  out.axis = (error.array() / power.array().max(1e-300)).sqrt();
  out.floor = (noise.array() / power.array().max(1e-300)).sqrt();
  out.axis = (is_base.array() > 0).select(0.0, out.axis.array());
  out.floor = (is_base.array() > 0).select(0.0, out.floor.array());
  out.overall = std::sqrt(error.sum() / std::max(power.sum(), 1e-300));
  out.overall_floor = std::sqrt(noise.sum() / std::max(power.sum(), 1e-300));
  out.measured_rms = rms_of(power.sum(), (is_base.array() == 0).count(), segment);
  Index worst = 0;
  out.worst = out.axis.maxCoeff(&worst);
  out.worst_axis = static_cast<int>(worst);
  return out;
}

std::optional<Gap> free_run_gap(const Plant& plant, const Model& model,
                                const RecordSegment& segment, std::size_t record, int ratio) {
  const RecordSegment even = with_model_error(plant, {segment}, 1).front();
  const Whitened system = whiten(plant, model, even, record, Forcing::simulated, {}, ratio);
  if (!system.good) return std::nullopt;
  return gap_of(plant, model, segment, system);
}

double mean_gap(const std::vector<Gap>& gaps, std::size_t from) {
  return mean_of(&Gap::overall, gaps, from);
}

double mean_floor(const std::vector<Gap>& gaps, std::size_t from) {
  return mean_of(&Gap::overall_floor, gaps, from);
}

}  // namespace framewatch::estimator
