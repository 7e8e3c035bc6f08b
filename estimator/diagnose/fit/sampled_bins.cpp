#include "estimator/diagnose/fit/sampled_bins.h"

#include <algorithm>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Chance of a bin per share of a column's square in it.
constexpr double kOfEffects = 8;

/// Returns the chances of the bins from the columns of effects: a resonance or a harmonic acts in
/// few bins.
VectorXd chances_of_effects(const Columns& columns, Index rows, Index bins) {
  VectorXd out = VectorXd::Zero(bins);
  for (Index e = 0; e < columns.effects.cols(); ++e) {
    const auto column = columns.effects.col(e);
    const double total = std::max(column.squaredNorm(), 1e-300);
    for (Index b = 0; b < bins; ++b)
      out[b] += kOfEffects * column.segment(rows * b, rows).squaredNorm() / total;
  }
  return out;
}

}  // namespace

std::vector<SampledBin> sampled_bins(const Linearised& at, std::size_t record) {
  constexpr Index kOneOf = 8, kFewest = 64;
  constexpr double kEvenly = 0.5;  // share of the chances that does not depend on the motion
  const Whitened& system = at.systems[record];
  const Index bins = system.bins();
  const double wanted = static_cast<double>(std::max(bins / kOneOf, std::min(bins, kFewest)));
  VectorXd motion = VectorXd::Zero(bins);
  for (std::size_t u = 0; u < at.unknowns.size(); ++u)
    if (at.unknowns[u].kind == Unknown::Kind::theta)
      motion += at.columns[record].size.col(static_cast<Index>(u)).cwiseAbs2();
  for (Index b = 0; b < bins; ++b) motion[b] *= system.weights->whitener(b).squared_norm();
  const double total = std::max(motion.sum(), 1e-300);
  const VectorXd of_effects =
      chances_of_effects(at.columns[record], 2 * system.operation.equations(), bins);
  std::vector<SampledBin> out;
  double passed = 0.5;  // of the sum of chances; a bin is taken where it passes a whole number
  for (Index b = 0; b < bins; ++b) {
    const double chance =
        std::min(1.0, of_effects[b] + wanted * (kEvenly / static_cast<double>(bins) +
                                                (1 - kEvenly) * motion[b] / total));
    passed += chance;
    if (passed < 1) continue;
    passed -= 1;
    out.push_back({b, 1 / chance});
  }
  return out;
}

}  // namespace framewatch::estimator
