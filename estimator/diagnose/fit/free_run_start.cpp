// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/free_run_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/law/law.h"

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

constexpr double kStiffer[] = {1, 1.6, 2.5, 4}, kNarrower[] = {1, 0.9, 0.8};
/// Forces of friction to try, relative to the spring's largest.
constexpr double kMinForce = 0.02, kNextForce = M_SQRT2;
constexpr std::size_t kForces = 14, kStarts = 2;
constexpr double kSticks = 3e-3;  ///< of the largest rate: friction sticks below it
constexpr double kSmoother = 3;
constexpr double kFits = 1.5;  ///< misfit over the expected, below which a fit is a good start

bool ends_with_clearance(const Model& model) {
  return !model.effects.empty() && is_contact(model.effects.back().form);
}

/// Returns a model's free run, not fitted.
FitResult as_it_runs(const Fitter& fitter, const Model& model,
                     const std::vector<Eigen::MatrixXcd>& motion) {
  FitOptions run;
  run.forcing = forcing_of(model);
  run.max_steps = 0;
  return fitter.fit(model, motion, run);
}

/// Refines friction between the tried forces, and its smoothness. A fit cannot do this: from a
/// force that is too large, friction sticks and no step lowers the cost.
FitResult refined_friction(const Fitter& fitter, FitResult best) {
  const auto try_with = [&](double force, double smoothness) {
    Model model = best.model;
    std::vector<LawParameter>& parameters = model.effects.back().parameters;
    parameters[FrictionIndex::fc].value *= force;
    parameters[FrictionIndex::v0].value += std::log(smoothness);
    return as_it_runs(fitter, model, {});
  };
  for (const double step : {std::sqrt(kNextForce), std::sqrt(std::sqrt(kNextForce))})
    for (FitResult& run : std::vector{try_with(1 / step, 1), try_with(step, 1)})
      if (is_better(run, best)) best = std::move(run);
  for (FitResult& run : std::vector{try_with(1, 1 / kSmoother), try_with(1, kSmoother)})
    if (is_better(run, best)) best = std::move(run);
  return best;
}

/// Returns the mean factor of the design over the frames of a model, except one.
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
      FitResult run = as_it_runs(fitter, model, fit.motion);
      if (is_better(run, best)) best = std::move(run);
    }
  return best.good ? best : fit;
}

std::vector<FitResult> friction_starts(const Fitter& fitter, const Model& from) {
  const Plant& plant = fitter.plant();
  Model model = from;
  ModelEffect& friction = model.effects.back();
  const int element = element_of(plant, friction.place);
  const double factor = mean_factor(plant, model, element);
  for (const Eigen::Index i : {Eigen::Index(element), element + plant.element_count()})
    model.theta[i] = factor * plant.design[i];
  friction.parameters[FrictionIndex::v0].value = std::log(kSticks * friction.rate);
  friction.parameters[FrictionIndex::fc].value =
      kMinForce * model.theta[element] * friction.deformation;
  std::vector<FitResult> tried;
  for (std::size_t i = 0; i < kForces; ++i) {
    tried.push_back(as_it_runs(fitter, model, {}));
    friction.parameters[FrictionIndex::fc].value *= kNextForce;
  }
  std::vector<FitResult> out;
  for (std::size_t i = 0; i < kForces; ++i)
    if (tried[i].good && (i == 0 || is_better(tried[i], tried[i - 1])) &&
        (i + 1 == kForces || is_better(tried[i], tried[i + 1])))
      out.push_back(refined_friction(fitter, tried[i]));
  std::stable_sort(out.begin(), out.end(), is_better);
  if (out.size() > kStarts) out.resize(kStarts);
  return out;
}

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
