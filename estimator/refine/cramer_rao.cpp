#include "estimator/refine/cramer_rao.h"

#include <cmath>
#include <limits>
#include <optional>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/refine/measured_building.h"
#include "estimator/refine/window_likelihood.h"

namespace framewatch::estimator {
namespace {

constexpr Eigen::Index kFewestInstants = 16;
/// Eigenvalue of the information, scaled to a unit diagonal, below which it is rounding error.
constexpr double kRoundingError = 1e-12;
/// Share of a parameter in such a direction above which its bound is infinite.
constexpr double kUnknownShare = 1e-4;

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

}  // namespace framewatch::estimator
