#include "estimator/diagnose/fit/free_run_start.h"

#include <cmath>
#include <utility>

namespace framewatch::estimator {
namespace {

constexpr double kStiffer[] = {1, 1.6, 2.5, 4}, kNarrower[] = {1, 0.9, 0.8};
constexpr double kFits = 1.5;  ///< misfit over the expected, below which a fit is a good start

bool ends_with_clearance(const Model& model) {
  if (model.effects.empty()) return false;
  const LawForm form = model.effects.back().form;
  return form == LawForm::gap_positive || form == LawForm::gap_negative ||
         form == LawForm::gap_both;
}

}  // namespace

FitResult free_run_start(const Fitter& fitter, FitResult fit) {
  if (!ends_with_clearance(fit.model) || fit.total_misfit() < kFits * fitter.expected(fit.model))
    return fit;
  FitOptions run;
  run.forcing = forcing_of(fit.model);
  run.max_steps = 0;
  FitResult best;
  for (const double stiffer : kStiffer)
    for (const double narrower : kNarrower) {
      Model model = fit.model;
      std::vector<LawParameter>& parameters = model.effects.back().parameters;
      parameters[0].value *= stiffer;
      parameters[1].value += std::log(narrower);
      FitResult started = fitter.fit(model, fit.motion, run);
      if (started.good && (!best.good || started.cost < best.cost)) best = std::move(started);
    }
  return best.good ? best : fit;
}

}  // namespace framewatch::estimator
