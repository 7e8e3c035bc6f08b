// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/softened_fit.h"

#include <algorithm>
#include <vector>

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kEstimates = 3;  ///< that the error is estimated: the third changes it by 2 %
constexpr Index kBeside = 2;   ///< bins on each side over which its power is averaged

/// Returns RecordSegment::model_error of a segment.
VectorXd model_error_of(const Plant& plant, const Whitened& system) {
  const Index n = plant.equations(), bins = system.bins();
  VectorXd power(bins), out(bins);
  for (Index b = 0; b < bins; ++b) power[b] = system.rest.segment(2 * n * b, 2 * n).squaredNorm();
  power /= static_cast<double>(plant.read_equations());
  for (Index b = 0; b < bins; ++b) {
    const Index from = std::max<Index>(0, b - kBeside), to = std::min(bins, b + kBeside + 1);
    out[b] = std::max(1.0, power.segment(from, to - from).mean());
  }
  return out;
}

}  // namespace

FitResult softened_fit(const Fitter& fitter, const FitResult& now) {
  if (now.total_misfit() < kNearNoise * fitter.expected(now.model)) return now;
  std::vector<RecordSegment> segments = fitter.segments();
  Model model = now.model;
  for (int i = 0; i < kEstimates; ++i) {
    const std::vector<Whitened> systems = fitter.systems(model, now.motion, forcing_of(model));
    if (systems.empty()) return now;
    for (std::size_t r = 0; r < systems.size(); ++r)
      segments[r].model_error = model_error_of(fitter.plant(), systems[r]);
    const FitResult soft = fitter.with(segments).fit(
        model, now.motion, thorough(model, fitter.settings().rough_steps));
    if (!soft.good) return now;
    model = soft.model;
  }
  const FitResult out = fitter.fit(model, now.motion, thorough(model, 0));
  return out.good ? out : now;
}

}  // namespace framewatch::estimator
