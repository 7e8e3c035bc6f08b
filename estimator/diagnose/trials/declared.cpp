#include "estimator/diagnose/trials/declared.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/propose/name_of_fit.h"

namespace framewatch::estimator {
namespace {

constexpr int kFitSteps = 5, kOnTheWay = 2;  ///< of the last fit, and of each before it

/// Replaces a spring of another shape by the equivalent power law.
void as_power(ModelEffect& effect) {
  Eigen::VectorXd d(1), none = Eigen::VectorXd::Zero(1);
  d << effect.deformation;
  const double at_end = law_force(effect.law(0), d, none, 1)[0];
  d << 1e-3 * effect.deformation;
  const double at_start = 1e3 * law_force(effect.law(0), d, none, 1)[0];
  const double force = at_end - at_start;
  effect.form = LawForm::power;
  effect.parameters = {linear_parameter(force, 0.02 * std::max(std::abs(force), 1e-12)),
                       bounded_parameter(2, 0.02, 1.2, 9)};
}

void fix_exponent(EffectKind kind, ModelEffect& effect) {
  if (kind == EffectKind::coulomb_friction && effect.form == LawForm::power_damping) {
    effect.form = LawForm::friction;
    effect.parameters[1] =
        logarithmic_parameter(0.01 * effect.rate, 1e-4 * effect.rate, 0.3 * effect.rate);
    return;
  }
  if (effect.form == LawForm::pinched && kind != EffectKind::pinching) {
    effect = without_slip(effect);
    if (kind == EffectKind::bilinear_hysteresis) effect.parameters.resize(HysteresisIndex::kOwn);
    return;
  }
  if (effect.form == LawForm::asymptotic) {
    const double spread = spread_like(effect.parameters[AsymptoteIndex::sharpness].plain());
    effect.form = LawForm::sliders;
    effect.parameters.resize(2);
    effect.parameters.push_back(bounded_parameter(spread, 0.02, 0, 0.98));
    effect.parameters.push_back(bounded_parameter(0, 0.005, 0, 5, false));
    return;
  }
  const bool elastic =
      kind == EffectKind::cubic_stiffness || kind == EffectKind::quadratic_stiffness;
  if (elastic && effect.form != LawForm::power) as_power(effect);
  if (effect.form != LawForm::power && effect.form != LawForm::power_damping) return;
  LawParameter& exponent = effect.parameters[1];
  const double value = kind == EffectKind::cubic_stiffness ? 3 : 2;
  exponent.value = exponent.logarithmic ? std::log(value) : value;
  exponent.free = false;
}

}  // namespace

Model declared_model(const Plant& plant, const std::vector<RecordSegment>& segments,
                     const Model& fitted,
                     const std::vector<const std::vector<FoundEffect>*>& effects,
                     const Parallel& within) {
  Model out = fitted;
  for (const std::vector<FoundEffect>* list : effects)
    for (const FoundEffect& found : *list)
      if (found.index >= 0)
        fix_exponent(found.chosen.kind, out.effects[static_cast<std::size_t>(found.index)]);
  const Model none = initial_model(plant);
  const auto shrink = [&](Eigen::VectorXd Model::*errors, double share,
                          const std::vector<int>& free) {
    for (Eigen::Index a = 0; a < (out.*errors).size(); ++a)
      if (std::find(free.begin(), free.end(), static_cast<int>(a)) == free.end())
        (out.*errors)[a] = share * (fitted.*errors)[a] + (1 - share) * (none.*errors)[a];
  };
  const Fitter exact(plant, segments, {0, 0, 0}, within);
  // In small steps: the fit of a stiff law may not converge if all errors are removed at once.
  for (const double share : {0.75, 0.5, 0.25, 0.0}) {
    shrink(&Model::mass_change, share, {});
    shrink(&Model::gain, share, out.free_gain);
    shrink(&Model::clock_s, share, out.free_clock);
    FitOptions options = thorough(out, share > 0 ? kOnTheWay : kFitSteps);
    options.through_run = share == 0;
    const FitResult next = exact.fit(out, {}, options);
    if (next.good) out = next.model;
  }
  return out;
}

}  // namespace framewatch::estimator
