// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/softened_fit.h"

#include <vector>

namespace framewatch::estimator {
namespace {

using Eigen::Index;

constexpr int kEstimates = 3;  ///< that the error is estimated: the third changes it by 2 %
constexpr Index kBeside = 2;   ///< bins on each side over which its power is averaged

}  // namespace

FitResult softened_fit(const Fitter& fitter, const FitResult& now) {
  if (now.total_misfit() < kNearNoise * fitter.expected(now.model)) return now;
  std::vector<RecordSegment> segments = fitter.segments();
  Model model = now.model;
  for (int i = 0; i < kEstimates; ++i) {
    const std::vector<Whitened> systems = fitter.systems(model, now.motion, forcing_of(model));
    if (systems.empty()) return now;
    for (std::size_t r = 0; r < systems.size(); ++r)
      segments[r].model_error =
          local_misfit(fitter.plant(), systems[r].rest, systems[r].bins(), kBeside).cwiseMax(1.0);
    const FitResult soft = fitter.with(segments).fit(
        model, now.motion, thorough(model, fitter.settings().rough_steps));
    if (!soft.good) return now;
    model = soft.model;
  }
  const FitResult out = fitter.fit(model, now.motion, thorough(model, 0));
  return out.good ? out : now;
}

}  // namespace framewatch::estimator
