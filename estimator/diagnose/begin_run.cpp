#include "estimator/diagnose/begin_run.h"

#include <cmath>
#include <utility>

namespace framewatch {
namespace {

constexpr double kStiffer[] = {1, 1.6, 2.5, 4}, kNarrower[] = {1, 0.9, 0.8};
constexpr int kBeginSteps = 3;
constexpr double kFits = 1.5;  ///< misfit over the expected, below which a start is near enough

bool ends_with_gap(const Model& model) {
  if (model.effects.empty()) return false;
  const LawForm form = model.effects.back().form;
  return form == LawForm::gap_positive || form == LawForm::gap_negative ||
         form == LawForm::gap_both;
}

bool ends_with_harmonic(const Model& model) {
  return !model.effects.empty() && model.effects.back().form == LawForm::harmonic;
}

/// A force that acts from where the record begins: its first part cannot be told from what the
/// record's ends leave, and was perhaps lost.
FitResult from_the_beginning(const Fitter& fitter, FitResult fit) {
  for (std::size_t r = 0; r < fitter.stretches().size(); ++r) {
    if (fit.model.effects.back().onset_s[r] == 0) continue;
    Model model = fit.model;
    model.effects.back().onset_s[r] = 0;
    FitOptions options;
    options.max_steps = kBeginSteps;
    FitResult whole = fitter.fit(model, fit.motion, options);
    if (whole.good && whole.cost < fit.cost) fit = std::move(whole);
  }
  return fit;
}

}  // namespace

FitResult begin_run(const Fitter& fitter, FitResult fit) {
  if (ends_with_harmonic(fit.model)) return from_the_beginning(fitter, std::move(fit));
  if (!ends_with_gap(fit.model) || fit.total_misfit() < kFits * fitter.expected(fit.model))
    return fit;
  FitOptions run;
  run.forcing = forcing_of(fit.model);
  run.max_steps = 0;
  FitResult best;
  for (const double stiffer : kStiffer)
    for (const double narrower : kNarrower) {
      Model model = fit.model;
      std::vector<Knob>& knobs = model.effects.back().knobs;
      knobs[0].value *= stiffer;
      knobs[1].value += std::log(narrower);
      FitResult begun = fitter.fit(model, fit.motion, run);
      if (begun.good && (!best.good || begun.cost < best.cost)) best = std::move(begun);
    }
  return best.good ? best : fit;
}

}  // namespace framewatch
