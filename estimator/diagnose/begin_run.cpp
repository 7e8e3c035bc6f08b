#include "estimator/diagnose/begin_run.h"

#include <cmath>
#include <utility>

namespace framewatch {
namespace {

constexpr double kStiffer[] = {1, 1.6, 2.5, 4}, kNarrower[] = {1, 0.9, 0.8};
constexpr double kFits = 1.5;  ///< misfit over the expected, below which a start is near enough

bool ends_with_gap(const Model& model) {
  if (model.effects.empty()) return false;
  const LawForm form = model.effects.back().form;
  return form == LawForm::gap_positive || form == LawForm::gap_negative ||
         form == LawForm::gap_both;
}

}  // namespace

FitResult begin_run(const Fitter& fitter, FitResult fit) {
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
