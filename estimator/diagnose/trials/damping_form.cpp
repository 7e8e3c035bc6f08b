#include "estimator/diagnose/trials/damping_form.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/trials/needless.h"

namespace framewatch::estimator {
namespace {

constexpr double kMisfit = 1.05;      ///< above it there is something to explain
constexpr double kNoRatio = 1e-4;     ///< below it there is none
constexpr double kStillFalls = 0.99;  ///< cost after a fit over that before: it goes on
constexpr int kTimes = 4;             ///< at most
constexpr int kStepsWith = 10, kStepsWithout = 5;

/// By how much the cost must fall for one value: half the logarithm of the number of data, times
/// what the misfit exceeds noise by.
double price_of(const Fitter& fitter, const FitResult& fit) {
  const double data = fitter.expected(fit.model);
  return 0.5 * std::log(data) * std::max(1.0, fit.total_misfit() / data);
}

double& ratio_of(Model& model, std::size_t effect) {
  return model.effects[effect].parameters[0].value;
}

/// Effects of modes whose frequency lies within the band of all records.
std::vector<std::size_t> modes_in_band(const Fitter& fitter, const Model& model) {
  std::vector<std::size_t> out;
  std::optional<ModelModes> modes;
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    if (model.effects[e].form != LawForm::modal_damping) continue;
    if (!modes) modes = modes_of(fitter.plant(), model);
    const double w = modes->w[model.effects[e].place.mode - 1];
    const auto& segments = fitter.segments();
    if (std::all_of(segments.begin(), segments.end(),
                    [w](const RecordSegment& s) { return w > s.w[0] && w < s.w[s.bins() - 1]; }))
      out.push_back(e);
  }
  return out;
}

void hold_at_zero(Model& model, std::size_t effect) {
  ratio_of(model, effect) = 0;
  model.effects[effect].parameters[0].free = false;
}

/// The fit without some of the ratios where that is no worse by more than their price.
bool does_without(const Fitter& fitter, const std::vector<std::size_t>& ratios, FitResult& now) {
  if (ratios.empty()) return true;
  Model less = now.model;
  for (const std::size_t e : ratios) hold_at_zero(less, e);
  FitResult without = fitter.fit(less, now.motion, thorough(less, kStepsWithout));
  const double price = static_cast<double>(ratios.size()) * price_of(fitter, now);
  if (!without.good || without.cost > now.cost + price) return false;
  now = std::move(without);
  return true;
}

/// Goes on without the ratios that are not worth their price, the smallest first.
void remove_needless(const Fitter& fitter, std::vector<std::size_t> ratios, FitResult& now) {
  std::vector<std::size_t> none;
  for (const std::size_t e : ratios)
    if (ratio_of(now.model, e) < kNoRatio) none.push_back(e);
  if (does_without(fitter, none, now))
    std::erase_if(ratios, [&](std::size_t e) {
      return std::find(none.begin(), none.end(), e) != none.end();
    });
  std::stable_sort(ratios.begin(), ratios.end(), [&](std::size_t a, std::size_t b) {
    return ratio_of(now.model, a) < ratio_of(now.model, b);
  });
  for (const std::size_t e : ratios) does_without(fitter, {e}, now);
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
  const std::vector<std::size_t> ratios = modes_in_band(fitter, now.model);
  if (ratios.empty() || now.total_misfit() < kMisfit * fitter.expected(now.model)) return {};
  FitResult out = now;
  for (const std::size_t e : ratios) out.model.effects[e].parameters[0].free = true;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTimes; ++i) {
    FitResult next = forcing_of(out.model) == Forcing::simulated
                         ? fit_to_the_end(fitter, out.model, out.motion)
                         : fitter.fit(out.model, out.motion, thorough(out.model, kStepsWith));
    if (!next.good) break;
    out = std::move(next);
    if (out.cost > kStillFalls * before) break;
    before = out.cost;
  }
  return out;
}

void settle_damping(const Fitter& fitter, FitResult with, FitResult& now) {
  const std::vector<std::size_t> ratios = modes_in_band(fitter, now.model);
  if (with.good && with.cost < now.cost - price_of(fitter, with)) {
    remove_needless(fitter, ratios, with);
    if (with.cost < now.cost) now = std::move(with);
  } else if (has_modal_damping(now.model)) {
    remove_needless(fitter, ratios, now);
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
