#include "estimator/diagnose/trials/declared.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr int kFitSteps = 5;  ///< of each fit

void fix_exponent(EffectKind kind, ModelEffect& effect) {
  if (effect.form != LawForm::power && effect.form != LawForm::power_damping) return;
  LawParameter& exponent = effect.parameters[1];
  const double value = kind == EffectKind::cubic_stiffness ? 3 : 2;
  exponent.value = exponent.logarithmic ? std::log(value) : value;
  exponent.free = false;
}

}  // namespace

Model declared_model(const Plant& plant, const std::vector<RecordSegment>& segments,
                     const Model& fitted,
                     const std::vector<const std::vector<FoundEffect>*>& effects) {
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
  const Fitter exact(plant, segments, {0, 0, 0});
  // Step by step: the fit of a stiff law may not converge when all errors are removed at once.
  for (const double share : {0.75, 0.5, 0.25, 0.0}) {
    shrink(&Model::mass_change, share, {});
    shrink(&Model::gain, share, out.free_gain);
    shrink(&Model::clock_s, share, out.free_clock);
    const FitResult next = exact.fit(out, {}, thorough(out, kFitSteps));
    if (next.good) out = next.model;
  }
  return out;
}

}  // namespace framewatch::estimator
