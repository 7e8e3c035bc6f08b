#include "estimator/diagnose/trials/needless.h"

#include <cstddef>
#include <utility>

#include "estimator/diagnose/fit/judged_fit.h"

namespace framewatch::estimator {
namespace {

constexpr int kJudgedSteps = 6;
constexpr double kNothing = 0.98;  ///< gap with an effect over the one without
constexpr int kRoughSteps = 4;
/// Gap with an effect over the one without after kRoughSteps, below which the effect reduces the
/// gap.
constexpr double kClearly = 0.75;

/// Replaces `now` by the fit of a smaller model, started from it, unless that is worse. Returns
/// true if it was replaced.
bool replaced_by(const Fitter& fitter, const Model& smaller, FitResult& now) {
  FitResult less = fit_to_the_end(fitter, smaller, now.motion);
  if (!less.good || less.cost > now.cost + kMinGain) return false;
  now = std::move(less);
  return true;
}

}  // namespace

FitResult fit_to_the_end(const Fitter& fitter, const Model& model,
                         const std::vector<Eigen::MatrixXcd>& motion) {
  FitResult out = fitter.fit(model, motion, thorough(model, kEndSteps));
  FitOptions along = thorough(out.model, kEndSteps);
  along.through_run = false;
  FitResult more = fitter.fit(out.model, out.motion, along);
  return more.good && more.cost < out.cost ? more : out;
}

bool removes_needless(const Fitter& fitter, const Model& before, FitResult& now) {
  Model start = now.model;
  start.effects.resize(before.effects.size());
  start.free_gain = before.free_gain;
  start.free_clock = before.free_clock;
  return replaced_by(fitter, start, now);
}

double gap_ratio(const Fitter& fitter, const Model& with, const Model& without,
                 const Parallel& parallel) {
  const Model* models[] = {&with, &without};
  double gaps[2];
  run_all(parallel, 2, [&](int i) {
    gaps[i] = judged_fit(fitter, {*models[i]}, kJudgedSteps, fitter.within()).gap;
  });
  return gaps[0] / gaps[1];
}

bool takes_nothing(const Fitter& fitter, const Model& with, const Model& without,
                   const Parallel& parallel) {
  const double first = free_run_fit(fitter, {without}, kRoughSteps, false).gap;
  if (rms_gap(fitter, with) < kClearly * first) return false;
  return gap_ratio(fitter, with, without, parallel) > kNothing;
}

void remove_needless_earlier(const Fitter& fitter, std::vector<FoundEffect>& effects,
                             FitResult& now) {
  for (std::size_t i = 0; i + 1 < effects.size(); ++i) {
    const int index = effects[i].index;
    if (index < 0 || now.model.effects[static_cast<std::size_t>(index)].element_law()) continue;
    Model start = now.model;
    start.effects.erase(start.effects.begin() + index);
    if (!replaced_by(fitter, start, now)) continue;
    effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(i));
    for (FoundEffect& e : effects) e.index -= e.index > index;
    effects.back().chosen.model = now.model;
    --i;
  }
}

}  // namespace framewatch::estimator
