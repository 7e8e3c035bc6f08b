// SPDX-License-Identifier: MIT
#include "estimator/refine/max_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/refine/group_likelihood.h"
#include "estimator/refine/window_likelihood.h"

namespace framewatch::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index kFewestInstants = 16;
/// Smallest eigenvalue of the information, scaled to a unit diagonal, that exceeds rounding error.
constexpr double kRoundingError = 1e-12;
/// Share of a parameter in a smaller direction from which on its bound is infinite.
constexpr double kUnknownShare = 1e-4;

constexpr int kHalvings = 12;
constexpr double kMinSnr = 10;         ///< information of a frame stiffness over that of noise
constexpr double kMinCurvature = 0.2;  ///< information of a step over that with noise
constexpr double kMinSignal = 1e-3;    ///< information of the standard errors over that with noise

/// Returns `information` minus its noise part, in every direction at least `least` times the whole.
MatrixXd signal_part(const MatrixXd& information, const MatrixXd& noise_part, double least) {
  const VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const VectorXd inverse = scale.cwiseInverse();
  MatrixXd whole = inverse.asDiagonal() * information * inverse.asDiagonal();
  const MatrixXd noise = inverse.asDiagonal() * noise_part * inverse.asDiagonal();
  whole.diagonal().array() += 1e-12;
  const RealEigen eigen = generalized_eigen(whole - noise, whole);
  if (!eigen.good) return least * information;
  const MatrixXd back = scale.asDiagonal() * whole * eigen.vectors;
  return back * eigen.values.cwiseMax(least).asDiagonal() * back.transpose();
}

/// One refinement in units of the design: x = theta / design.
class Refiner {
 public:
  Refiner(SegmentLikelihood& likelihood, bool noise_known, const ParameterTable& table,
          const VectorXd& design, const RefineOptions& options)
      : likelihood_(likelihood),
        noise_known_(noise_known),
        table_(table),
        design_(design),
        options_(options),
        prior_(VectorXd::Zero(table.size())) {
    if (!options.prior) return;
    for (int p = 0; p < table.size(); ++p)
      prior_[p] = 1 / (design_tolerance(table[p].kind) * design_tolerance(table[p].kind));
  }

  Refinement run(VectorXd x) {
    Refinement out;
    out.band = likelihood_.spectrum().band;
    out.bins = static_cast<int>(likelihood_.spectrum().bins());
    out.status = RefineStatus::not_converged;
    auto point = at(x);
    for (; point && out.status == RefineStatus::not_converged &&
           out.iterations < options_.max_iterations;
         ++out.iterations) {
      if (options_.progress) options_.progress(out.iterations + 1);
      const auto step = step_at(x, *point);
      if (!step) break;
      const double longest = step->cwiseAbs().maxCoeff();
      const VectorXd limited = *step * std::min(1.0, options_.longest_step / longest);
      const double before = cost(x, point->misfit);
      double share = 1;
      for (int i = 0; i < kHalvings && !lower(x + share * limited, before); ++i) share /= 2;
      const bool small = step->cwiseQuotient(error_).cwiseAbs().maxCoeff() < options_.tolerance;
      if (lower(x + share * limited, before))
        x += share * limited;
      else if (!small)
        break;
      if (small) out.status = RefineStatus::converged;
      point = at(x);
    }
    if (!point) {
      out.status = RefineStatus::failed;
      return out;
    }
    report(x, *point, out);
    return out;
  }

 private:
  std::optional<LikelihoodPoint> at(const VectorXd& x) {
    auto point = likelihood_.at(x.cwiseProduct(design_));
    if (!point) return point;
    point->gradient = point->gradient.cwiseProduct(design_);
    point->information = design_.asDiagonal() * point->information * design_.asDiagonal();
    point->noise_part = design_.asDiagonal() * point->noise_part * design_.asDiagonal();
    level_ = misfit_ratio(point->misfit);
    return point;
  }

  double misfit_ratio(double misfit) const {
    const double fitted = 0.5 * static_cast<double>(likelihood_.end_unknowns() + table_.size());
    return misfit / std::max(likelihood_.observations() - fitted, 1.0);
  }

  /// Returns actual over configured noise, which scales the prior.
  double noise_level() const { return noise_known_ ? std::max(level_, 1.0) : level_; }
  VectorXd pull() const { return noise_level() * prior_; }

  double cost(const VectorXd& x, double misfit) const {
    return misfit + 0.5 * pull().dot((x.array() - 1).square().matrix());
  }

  bool lower(const VectorXd& x, double before) {
    const auto misfit = likelihood_.misfit(x.cwiseProduct(design_));
    return misfit && cost(x, *misfit) < before;
  }

  std::optional<VectorXd> step_at(const VectorXd& x, const LikelihoodPoint& point) {
    MatrixXd curvature = signal_part(point.information, point.noise_part, kMinCurvature);
    curvature.diagonal() += pull();
    const Ldlt factor(curvature);
    if (!factor.good() || !factor.positive()) return std::nullopt;
    const VectorXd gradient = point.gradient + pull().cwiseProduct((x.array() - 1).matrix());
    error_ = std::sqrt(noise_level()) *
             factor.solve(MatrixXd(MatrixXd::Identity(table_.size(), table_.size())))
                 .diagonal()
                 .cwiseMax(0)
                 .cwiseSqrt();
    VectorXd step = -factor.solve(gradient);
    if (!step.allFinite() || !(error_.array() > 0).all()) return std::nullopt;
    return step;
  }

  void report(const VectorXd& x, const LikelihoodPoint& point, Refinement& out) {
    const double level = noise_level();
    double best_snr = 0;
    for (int p = 0; p < table_.elements(); ++p)
      if (table_[p].kind == ParameterKind::frame_stiffness)
        best_snr = std::max(best_snr, point.information(p, p) / (level * point.noise_part(p, p)));
    if (!(best_snr >= kMinSnr)) {
      out.status = RefineStatus::quiet;
      return;
    }
    const MatrixXd signal = signal_part(point.information, level * point.noise_part, kMinSignal);
    MatrixXd curvature = signal, score = point.information;
    curvature.diagonal() += prior_ * level;
    score.diagonal() += prior_ * level;
    const MatrixXd inverse =
        Ldlt(curvature).solve(MatrixXd(MatrixXd::Identity(table_.size(), table_.size())));
    out.theta = x.cwiseProduct(design_);
    out.covariance =
        design_.asDiagonal() * (level * inverse * score * inverse) * design_.asDiagonal();
    out.std_error = out.covariance.diagonal().cwiseMax(0).cwiseSqrt();
    out.bound = std::sqrt(level) * bound_of(signal).cwiseProduct(design_);
    out.misfit_ratio = level_;
    out.log_likelihood = -point.misfit;
    for (const double variance_of_axis : likelihood_.variance())
      out.log_likelihood -=
          static_cast<double>(likelihood_.spectrum().bins()) *
          std::log(std::numbers::pi * likelihood_.spectrum().intervals * variance_of_axis);
  }

  SegmentLikelihood& likelihood_;
  bool noise_known_;
  const ParameterTable& table_;
  const VectorXd& design_;
  RefineOptions options_;
  VectorXd prior_;
  VectorXd error_;
  double level_ = 1;
};

bool all_positive(const VectorXd& values, int size) {
  return values.size() == size && values.allFinite() && (values.array() > 0).all();
}

RefineStatus refused(SegmentStatus status) {
  switch (status) {
    case SegmentStatus::missing_sensors:
      return RefineStatus::missing_sensors;
    case SegmentStatus::bad_samples:
      return RefineStatus::bad_samples;
    case SegmentStatus::too_short:
      return RefineStatus::too_short;
    default:
      return RefineStatus::bad_input;
  }
}

}  // namespace

SegmentStatus check_segment(const Structure& structure, const std::vector<SensorAxis>& axes,
                            const Eigen::VectorXd& theta, double rate_hz,
                            const Eigen::MatrixXd& accel_abs) {
  if (!problems(structure).empty() || !(rate_hz > 0) || !std::isfinite(rate_hz))
    return SegmentStatus::bad_input;
  const ParameterTable table(structure);
  if (accel_abs.cols() != static_cast<Eigen::Index>(axes.size()) || theta.size() != table.size() ||
      !theta.allFinite() || !(theta.array() > 0).all())
    return SegmentStatus::bad_input;
  for (const SensorAxis& axis : axes)
    if (axis.story < 0 || axis.story > structure.stories || axis.frame >= structure.frames() ||
        (axis.story > 0 && axis.frame < 0) || !std::isfinite(axis.delay) ||
        !std::isfinite(axis.noise_density))
      return SegmentStatus::bad_input;
  const auto building = measured_building(structure, table, axes, rate_hz);
  if (!building) return SegmentStatus::missing_sensors;
  if (!accel_abs.allFinite()) return SegmentStatus::bad_samples;
  if (accel_abs.rows() < kFewestInstants) return SegmentStatus::too_short;
  const Band band = structure_band(structure, table, theta, rate_hz);
  const double step_hz = rate_hz / static_cast<double>(accel_abs.rows() - 1);
  const double bins = std::floor(band.high_hz / step_hz) - std::ceil(band.low_hz / step_hz) + 1;
  const auto end_unknowns = static_cast<double>(EndTerms::sampled);
  const auto equations = static_cast<double>(building->equations());
  const bool enough =
      bins > end_unknowns && 2 * bins * equations >= end_unknowns * equations + 2.0 * table.size();
  return enough ? SegmentStatus::good : SegmentStatus::too_short;
}

Eigen::VectorXd bound_of(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale =
      information.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt();
  const Eigen::MatrixXd scaled =
      scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal();
  const RealEigen eigen = symmetric_eigen(scaled);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(information.rows());
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < variance.size(); ++i) {
    const double value = eigen.values[i];
    const auto vector = eigen.vectors.col(i);
    for (Eigen::Index p = 0; p < variance.size(); ++p) {
      if (value > kRoundingError)
        variance[p] += vector[p] * vector[p] / value;
      else if (std::abs(vector[p]) > kUnknownShare)
        variance[p] = kInfinity;
    }
  }
  for (Eigen::Index p = 0; p < variance.size(); ++p)
    if (!(information(p, p) > std::numeric_limits<double>::min())) variance[p] = kInfinity;
  return variance.cwiseSqrt().cwiseQuotient(scale);
}

CramerRaoBound cramer_rao_bound(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const Eigen::VectorXd& theta, double rate_hz,
                                const Eigen::MatrixXd& accel_abs) {
  CramerRaoBound out;
  out.status = check_segment(structure, axes, theta, rate_hz, accel_abs);
  if (out.status != SegmentStatus::good) return out;
  const ParameterTable table(structure);
  const auto building = measured_building(structure, table, axes, rate_hz);
  const Spectrum spectrum = spectrum_of(accel_abs, building->delay, rate_hz,
                                        structure_band(structure, table, theta, rate_hz));
  WindowLikelihood likelihood(*building, spectrum, EndTerms::states);
  const auto information = likelihood.information_of_exact_motion(theta);
  if (!information) {
    out.status = SegmentStatus::too_short;
    return out;
  }
  out.std_error = bound_of(*information);
  out.band = spectrum.band;
  out.bins = static_cast<int>(spectrum.bins());
  return out;
}

Refinement refine_max_likelihood(const Structure& structure, const std::vector<SensorAxis>& axes,
                                 double rate_hz, const MatrixXd& accel_abs, const VectorXd& design,
                                 const VectorXd& start, const RefineOptions& options) {
  Refinement out;
  const SegmentStatus segment = check_segment(structure, axes, start, rate_hz, accel_abs);
  if (segment != SegmentStatus::good) {
    out.status = refused(segment);
    return out;
  }
  const ParameterTable table(structure);
  if (!all_positive(design, table.size())) return out;
  const auto building = measured_building(structure, table, axes, rate_hz);
  const Spectrum spectrum = spectrum_of(accel_abs, building->delay, rate_hz,
                                        structure_band(structure, table, start, rate_hz));
  WindowLikelihood likelihood(*building, spectrum, EndTerms::sampled);
  return Refiner(likelihood, building->noise_known, table, design, options)
      .run(start.cwiseQuotient(design));
}

Refinement refine_max_likelihood(const PipelineConfig& config, const MatrixXd& accel_abs,
                                 const VectorXd& design, const VectorXd& start,
                                 const RefineOptions& options) {
  const double rate_hz = config.options.rate_hz;
  const ParameterTable table = config.parameters();
  if (!table.grouped())
    return refine_max_likelihood(config.structure, config.axes, rate_hz, accel_abs, design, start,
                                 options);
  Refinement out;
  if (accel_abs.cols() != static_cast<Eigen::Index>(config.axes.size()) || !(rate_hz > 0) ||
      !all_positive(design, table.size()) || !all_positive(start, table.size()))
    return out;
  const MeasuredGroups groups = measured_groups(config);
  if (groups.equations() == 0) out.status = RefineStatus::missing_sensors;
  if (groups.equations() > 0 && !accel_abs.allFinite()) out.status = RefineStatus::bad_samples;
  if (out.status != RefineStatus::bad_input) return out;
  const Spectrum spectrum =
      spectrum_of(accel_abs, groups.delay, rate_hz, groups_band(groups, start, rate_hz));
  GroupLikelihood likelihood(groups, spectrum, EndTerms::sampled);
  if (2 * likelihood.observations() <=
      static_cast<double>(likelihood.end_unknowns()) + 2.0 * table.size()) {
    out.status = RefineStatus::too_short;
    return out;
  }
  return Refiner(likelihood, groups.noise_known, table, design, options)
      .run(start.cwiseQuotient(design));
}

const char* status_word(RefineStatus status) {
  switch (status) {
    case RefineStatus::converged:
      return "converged";
    case RefineStatus::not_converged:
      return "not converged";
    case RefineStatus::bad_input:
      return "bad input";
    case RefineStatus::missing_sensors:
      return "missing sensors";
    case RefineStatus::bad_samples:
      return "bad samples";
    case RefineStatus::too_short:
      return "too short";
    case RefineStatus::quiet:
      return "quiet";
    case RefineStatus::failed:
      break;
  }
  return "failed";
}

}  // namespace framewatch::estimator
