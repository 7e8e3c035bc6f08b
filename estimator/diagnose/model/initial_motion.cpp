#include "estimator/diagnose/model/initial_motion.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kFewestSamples = 64;
constexpr double kTaper = 0.05;    ///< of the record, at either end
constexpr Index kFirstShare = 20;  ///< the lead begins with its first 1/20
constexpr double kMoving = 0.1;
constexpr Index kOfLead = 4;  ///< the initial instant lies a quarter into the lead

double taper(Index i, Index size) {
  const double edge = kTaper * static_cast<double>(size);
  const double at = static_cast<double>(std::min(i, size - 1 - i)) / edge;
  return at < 1 ? 0.5 - 0.5 * std::cos(M_PI * at) : 1.0;
}

/// Returns true if the floors move at the start: compares the rms of the readings there with that
/// of the whole lead.
bool begins_in_motion(const Plant& plant, const RecordSegment& segment) {
  const Index first = std::max<Index>(1, segment.lead.rows() / kFirstShare);
  double begin = 0, all = 0;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    if (plant.is_input(a)) continue;
    begin += segment.lead.col(a).head(first).squaredNorm() / static_cast<double>(first);
    all += segment.lead.col(a).squaredNorm() / static_cast<double>(segment.lead.rows());
  }
  return begin > kMoving * kMoving * all;
}

}  // namespace

std::optional<InitialMotion> initial_motion(const Plant& plant, const Model& model,
                                            const RecordSegment& segment) {
  const Index lead = segment.lead.rows();
  const Index size = smooth_size(lead + segment.accel.rows());
  if (lead == 0 || size < kFewestSamples || segment.w.size() == 0) return std::nullopt;
  if (!begins_in_motion(plant, segment)) return std::nullopt;
  InitialMotion out;
  out.sample = std::max(lead / kOfLead, static_cast<Index>(kTaper * static_cast<double>(size)) + 1);
  if (out.sample >= lead) return std::nullopt;
  VectorXd place = VectorXd::Zero(plant.building.axes()), rate = place;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    VectorXd reading(size);
    for (Index i = 0; i < size; ++i)
      reading[i] = taper(i, size) * (i < lead ? segment.lead(i, a) : segment.accel(i - lead, a)) /
                   (1 + model.gain[a]);
    VectorXcd bins = forward_fourier(reading), rates = bins;
    for (Index k = 0; k < bins.size(); ++k) {
      const double w =
          2 * M_PI * segment.rate_hz * static_cast<double>(k) / static_cast<double>(size);
      const bool inside = w >= segment.w[0] && w <= segment.w.tail(1)[0];
      bins[k] = !inside ? 0 : segment.is_displaced(a) ? bins[k] : Complex(-bins[k] / (w * w));
      rates[k] = kJ * w * bins[k];
    }
    place[a] = inverse_fourier(bins, size)[out.sample];
    rate[a] = inverse_fourier(rates, size)[out.sample];
  }
  const LeastSquares coordinates(plant.constraint);
  const auto relative = [&](const VectorXd& of_axes) {
    return VectorXd(plant.motion * of_axes - coordinates.solve(VectorXd(plant.ground * of_axes)));
  };
  out.displacement = relative(place);
  out.velocity = relative(rate);
  return out;
}

}  // namespace framewatch::estimator
