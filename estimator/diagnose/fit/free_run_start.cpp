#include "estimator/diagnose/fit/free_run_start.h"

#include <cmath>
#include <utility>

#include "estimator/diagnose/law/sliding.h"

namespace framewatch::estimator {
namespace {

constexpr double kStiffer[] = {1, 1.6, 2.5, 4}, kNarrower[] = {1, 0.9, 0.8};
constexpr double kForces[] = {0.02, 0.04, 0.08, 0.16, 0.3, 0.6};  ///< of the spring's largest
constexpr double kSticks = 3e-3;  ///< of the largest rate: below it friction holds
constexpr double kFits = 1.5;     ///< misfit over the expected, below which a fit is a good start

bool ends_with_clearance(const Model& model) {
  return !model.effects.empty() && is_contact(model.effects.back().form);
}

/// Keeps the better of a fit and of a model's free run as it is.
void take_better(FitResult& best, const Fitter& fitter, const Model& model,
                 const std::vector<Eigen::MatrixXcd>& motion) {
  FitOptions run;
  run.forcing = forcing_of(model);
  run.max_steps = 0;
  FitResult started = fitter.fit(model, motion, run);
  if (started.good && (!best.good || started.cost < best.cost)) best = std::move(started);
}

/// Mean factor of the design that the frames of a model have, but one.
double mean_factor(const Plant& plant, const Model& model, int but) {
  double sum = 0;
  int count = 0;
  for (const Element& element : plant.elements) {
    if (element.frame < 0 || element.stiffness == but) continue;
    sum += model.theta[element.stiffness] / plant.design[element.stiffness];
    ++count;
  }
  return count > 0 ? sum / count : 1;
}

}  // namespace

FitResult free_run_start(const Fitter& fitter, FitResult fit) {
  if (!ends_with_clearance(fit.model) || fit.total_misfit() < kFits * fitter.expected(fit.model))
    return fit;
  FitResult best;
  for (const double stiffer : kStiffer)
    for (const double narrower : kNarrower) {
      Model model = fit.model;
      std::vector<LawParameter>& parameters = model.effects.back().parameters;
      parameters[0].value *= stiffer;
      parameters[1].value += std::log(narrower);
      take_better(best, fitter, model, fit.motion);
    }
  return best.good ? best : fit;
}

FitResult friction_start(const Fitter& fitter, const Model& from) {
  const Plant& plant = fitter.plant();
  Model model = from;
  ModelEffect& friction = model.effects.back();
  const int element = element_of(plant, friction.place);
  const double factor = mean_factor(plant, model, element);
  for (const Eigen::Index i : {Eigen::Index(element), element + plant.element_count()})
    model.theta[i] = factor * plant.design[i];
  FitResult best;
  friction.parameters[FrictionIndex::v0].value = std::log(kSticks * friction.rate);
  for (const double share : kForces) {
    friction.parameters[FrictionIndex::fc].value =
        share * model.theta[element] * friction.deformation;
    take_better(best, fitter, model, {});
  }
  return best;
}

}  // namespace framewatch::estimator
