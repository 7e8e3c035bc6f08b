#include "estimator/diagnose/fit/onset.h"

#include <algorithm>
#include <utility>

namespace framewatch::estimator {
namespace {

constexpr double kFirstStep = 0.01;  ///< of the record
constexpr int kOnsetSteps = 1;       ///< of a fit that compares onsets
constexpr int kSettlingSteps = 4;    ///< after the last onset
constexpr double kMinGain = 1;       ///< of the misfit

/// Replaces the fit by one with another onset if that is better. Returns true if it was.
bool moved(const Fitter& fitter, std::size_t record, double onset_s, FitResult& fit) {
  FitOptions options;
  options.max_steps = kOnsetSteps;
  options.holds_tolerated = true;
  Model model = fit.model;
  double& onset = model.effects.back().onset_s[record];
  if (onset == std::max(0.0, onset_s)) return false;
  onset = std::max(0.0, onset_s);
  FitResult other = fitter.fit(model, fit.motion, options);
  if (!other.good || other.cost > fit.cost - kMinGain) return false;
  fit = std::move(other);
  return true;
}

}  // namespace

bool ends_with_harmonic(const Model& model) {
  return !model.effects.empty() && model.effects.back().form == LawForm::harmonic;
}

FitResult with_onsets(const Fitter& fitter, FitResult fit) {
  for (std::size_t r = 0; r < fitter.segments().size(); ++r) {
    const RecordSegment& s = fitter.segments()[r];
    const auto onset = [&] { return fit.model.effects.back().onset_s[r]; };
    if (onset() > 0) moved(fitter, r, 0, fit);
    for (double step = kFirstStep * s.seconds(); step > 1 / s.rate_hz; step /= 2)
      while (moved(fitter, r, onset() - step, fit) || moved(fitter, r, onset() + step, fit)) {
      }
  }
  FitOptions options;
  options.max_steps = kSettlingSteps;
  FitResult last = fitter.fit(fit.model, fit.motion, options);
  return last.good && last.cost < fit.cost ? last : fit;
}

}  // namespace framewatch::estimator
