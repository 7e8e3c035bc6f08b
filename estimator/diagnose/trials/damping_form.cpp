// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/damping_form.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/trials/linear_gains.h"
#include "estimator/diagnose/trials/refit.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoRatio = 1e-4;     ///< below it a ratio counts as zero
constexpr double kDamperStep = 0.05;  ///< of the largest dashpot of the design
constexpr double kStillFalls =
    0.99;                  ///< cost after a fit over that before, below which fits continue
constexpr int kTimes = 4;  ///< largest number of fits

/// Returns the fall of the cost that justifies one value: half the logarithm of the number of data,
/// times the ratio of the misfit to noise.
double price_of(const Fitter& fitter, const FitResult& fit) {
  const double data = fitter.expected(fit.model);
  return 0.5 * std::log(data) * std::max(1.0, fit.total_misfit() / data);
}

double& ratio_of(Model& model, std::size_t effect) {
  return model.effects[effect].parameters[0].value;
}

void hold_at_zero(Model& model, std::size_t effect) {
  ratio_of(model, effect) = 0;
  model.effects[effect].parameters[0].free = false;
}

/// A model without some ratios, at the minimum that a quadratic model of the cost predicts.
struct FewerRatios {
  Model model;
  std::size_t removed = 0;
};

/// Removes the ratios that reduce the cost by less than their price, the least useful first, and
/// adjusts everything else.
FewerRatios without_redundant(const Fitter& fitter, const std::vector<std::size_t>& ratios,
                              const FitResult& now) {
  FewerRatios out{now.model};
  std::vector<Whitened> systems = fitter.systems(now.model, now.motion, forcing_of(now.model));
  if (systems.empty()) return out;
  const Linearised at = fitter.linearise(now.model, std::move(systems), thorough(now.model, 0));
  MatrixXd normal = normal_equations(at, fitter.within()).normal;
  normal.diagonal() += at.prior;
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  MatrixXd spread = inverse(scaled);  // of the values, by their scale
  const double price = price_of(fitter, now);
  std::vector<Index> gone;
  VectorXd value = VectorXd::Zero(spread.rows());
  std::vector<Index> left;
  for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
    value[static_cast<Index>(u)] =
        value_of(now.model, at.unknowns[u]) / scale[static_cast<Index>(u)];
    const bool own = at.unknowns[u].kind == Unknown::Kind::parameter &&
                     std::find(ratios.begin(), ratios.end(),
                               static_cast<std::size_t>(at.unknowns[u].index)) != ratios.end();
    if (own) left.push_back(static_cast<Index>(u));
  }
  const VectorXd before = value;
  while (!left.empty()) {
    const auto loss = [&](Index u) { return value[u] * value[u] / spread(u, u); };
    const auto least = std::min_element(left.begin(), left.end(),
                                        [&](Index a, Index b) { return loss(a) < loss(b); });
    const Index u = *least;
    if (loss(u) > price) break;
    gone.push_back(u);
    left.erase(least);
    const VectorXd column = spread.col(u);
    value -= column * (value[u] / spread(u, u));
    spread -= column * column.transpose() / spread(u, u);
  }
  out.model = fitter.moved(now.model, at.unknowns, scale.cwiseProduct(value - before));
  for (const Index u : gone)
    hold_at_zero(out.model,
                 static_cast<std::size_t>(at.unknowns[static_cast<std::size_t>(u)].index));
  out.removed = gone.size();
  return out;
}

/// Refits without the ratios that reduce the cost by less than their price.
void remove_redundant_ratios(const Fitter& fitter, const std::vector<std::size_t>& ratios,
                             FitResult& now) {
  const FewerRatios fewer = without_redundant(fitter, ratios, now);
  if (fewer.removed == 0) return;
  FitResult without =
      fitter.fit(fewer.model, now.motion, thorough(fewer.model, fitter.settings().long_steps));
  const double price = static_cast<double>(fewer.removed) * price_of(fitter, now);
  if (without.good && without.cost < now.cost + price) now = std::move(without);
}

}  // namespace

void add_modal_damping(const Plant& plant, Model& model) {
  if (plant.prescribed || plant.is_large() || plant.equations() < 2) return;
  for (int mode = 1; mode <= static_cast<int>(plant.equations()); ++mode) {
    if (std::any_of(model.effects.begin(), model.effects.end(), [mode](const ModelEffect& e) {
          return e.form == LawForm::modal_damping && e.place.mode == mode;
        }))
      continue;
    ModelEffect ratio;
    ratio.form = LawForm::modal_damping;
    ratio.place.kind = PlaceKind::mode;
    ratio.place.mode = mode;
    ratio.parameters = {modal_ratio(0)};
    ratio.parameters[0].free = false;
    model.effects.push_back(std::move(ratio));
  }
}

FitResult with_free_damping(const Fitter& fitter, const FitResult& now) {
  const std::vector<std::size_t> ratios =
      modes_in_band(fitter.plant(), now.model, fitter.segments());
  const bool held = std::any_of(ratios.begin(), ratios.end(), [&](std::size_t e) {
    return !now.model.effects[e].parameters[0].free;
  });
  if (!held || now.total_misfit() < fitter.settings().to_explain * fitter.expected(now.model))
    return {};
  FitResult out = now;
  for (const std::size_t e : ratios) out.model.effects[e].parameters[0].free = true;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTimes; ++i) {
    const bool runs = forcing_of(out.model) == Forcing::simulated;
    FitResult next =
        runs ? fit_to_the_end(fitter, out.model, out.motion)
             : fitter.fit(out.model, out.motion, thorough(out.model, fitter.settings().long_steps));
    if (!next.good) break;
    out = std::move(next);
    if (out.cost > kStillFalls * before ||
        out.steps < (runs ? fitter.settings().steps : fitter.settings().long_steps))
      break;
    before = out.cost;
  }
  return out;
}

bool one_damper_does(const TrialContext& context, const FitResult& with) {
  const Plant& plant = context.fitter.plant();
  const FitResult& now = context.now;
  std::vector<ModelEffect> dampers;
  for (const EffectPlace& place :
       effect_places(EffectKind::added_damper, plant.structure, plant.axes)) {
    ModelEffect damper;
    damper.form = LawForm::damper;
    damper.place = place;
    const double size = plant.design.tail(plant.element_count()).maxCoeff();
    damper.parameters = {bounded_parameter(0, kDamperStep * size, 0, 1e15)};
    dampers.push_back(std::move(damper));
  }
  const std::vector<LinearGain> gains = linear_gains(context, dampers);
  std::vector<std::size_t> order(dampers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return gains[a].cost > gains[b].cost; });
  order.resize(std::min(order.size(), context.settings().dampers));
  double ratios = 0;
  for (const ModelEffect& e : with.model.effects)
    ratios += e.form == LawForm::modal_damping && e.parameters[0].plain() > kNoRatio;
  const double enough = with.cost + (ratios - 1) * price_of(context.fitter, with);
  return std::any_of(order.begin(), order.end(), [&](std::size_t i) {
    if (!(gains[i].value > 0)) return false;
    Model one = now.model;
    one.effects.push_back(dampers[i]);
    one.effects.back().parameters[0].value = gains[i].value;
    const FitResult fit =
        context.fitter.fit(one, now.motion, thorough(one, context.settings().long_steps));
    return fit.good && fit.cost < enough;
  });
}

void settle_damping(const Fitter& fitter, FitResult with, FitResult& now) {
  const std::vector<std::size_t> ratios =
      modes_in_band(fitter.plant(), now.model, fitter.segments());
  if (with.good && with.cost < now.cost - price_of(fitter, with)) {
    remove_redundant_ratios(fitter, ratios, with);
    if (with.cost < now.cost) now = std::move(with);
  } else if (has_modal_damping(now.model)) {
    remove_redundant_ratios(fitter, ratios, now);
  }
}

std::vector<Effect> modal_damping_effects(const Model& model) {
  std::vector<Effect> out;
  for (const ModelEffect& e : model.effects) {
    if (e.form != LawForm::modal_damping || e.parameters[0].plain() == 0) continue;
    out.push_back(make_effect(EffectKind::modal_damping, e.place));
    out.back().set("damping_ratio", e.parameters[0].plain());
  }
  return out;
}

}  // namespace framewatch::estimator
