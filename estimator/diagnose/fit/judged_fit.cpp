// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/judged_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/model/modal_damping.h"

namespace framewatch::estimator {
namespace {

constexpr double kDiverged = std::numeric_limits<double>::infinity();
constexpr int kRounds = 6;  ///< in which the weights follow the gap
constexpr double kMore =
    0.99;  ///< gap over that of the previous round, below which rounds continue
constexpr double kLargest = 1;  ///< model error in the weights
constexpr double kFewDashpots = 0.1, kUsualRatio = 0.005;
constexpr double kSameGap = 1e-9;  ///< relative difference of gaps of one model
constexpr double kSameEnd = 5e-3;  ///< relative difference of gaps of fits that ended at one place

struct Start {
  Model model;
  double gap = kDiverged;
};

/// Fits the free run of a model with its gap as model error in the weights. Unchanged if the result
/// is worse.
void fit_free_run(const Fitter& fitter, int steps, Start& at) {
  const std::vector<RecordSegment> segments =
      with_model_error(fitter.plant(), fitter.segments(), std::min(at.gap, kLargest));
  const Fitter weighted = fitter.with(segments);
  const FitResult fit = weighted.fit(at.model, {}, thorough(at.model, steps));
  if (!fit.good) return;
  const double gap = rms_gap(fitter, fit.model);
  if (gap < at.gap) at = {fit.model, gap};
}

void fit_to_the_end(const Fitter& fitter, int steps, Start& at) {
  for (int round = 0; round < kRounds; ++round) {
    const double before = at.gap;
    fit_free_run(fitter, steps, at);
    if (at.gap > kMore * before) return;
  }
}

/// Sorts by gap. Keeps one of those whose gaps differ by less than a share `same`.
void sort_starts(double same, std::vector<Start>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Start& a, const Start& b) { return a.gap < b.gap; });
  const auto is_same = [same](const Start& a, const Start& b) {
    return b.gap - a.gap < same * a.gap;
  };
  all.erase(std::unique(all.begin(), all.end(), is_same), all.end());
}

/// Removes starts whose gap is far above that of the first, the best.
void keep_close(double nearly_best, std::vector<Start>& sorted) {
  const double limit = nearly_best * sorted.front().gap;
  sorted.erase(std::find_if(sorted.begin() + 1, sorted.end(),
                            [&](const Start& s) { return !(s.gap < limit); }),
               sorted.end());
}

/// Returns starts that free the damping ratios of the modes in the band: with the dashpots, and
/// with few of them. Returns an empty list if all ratios are free already.
std::vector<Model> with_ratios(const Fitter& fitter, const Model& model) {
  const Plant& plant = fitter.plant();
  const std::vector<std::size_t> ratios = modes_in_band(plant, model, fitter.segments());
  Model beside = model;
  bool any = false;
  for (const std::size_t e : ratios) {
    LawParameter& ratio = beside.effects[e].parameters[0];
    any = any || !ratio.free;
    ratio.free = true;
  }
  if (!any) return {};
  Model instead = beside;
  const auto elements = plant.element_count();
  instead.theta.tail(elements) *= kFewDashpots;
  for (const std::size_t e : ratios) {
    double& ratio = instead.effects[e].parameters[0].value;
    ratio = std::max(ratio, kUsualRatio);
  }
  return {std::move(beside), std::move(instead)};
}

/// Frees modal damping ratios if the gap falls clearly with them, because dashpots between floors
/// cannot describe all damping. ends: of the fits without ratios, best first; the best fit with
/// ratios may start at another one.
Start with_free_ratios(const Fitter& fitter, int steps, const std::vector<Start>& ends,
                       const Parallel& parallel) {
  std::vector<Start> all;
  for (const Start& end : ends)
    for (Model& model : with_ratios(fitter, end.model)) all.push_back({std::move(model)});
  run_all(parallel, static_cast<int>(all.size()), [&](int i) {
    Start& one = all[static_cast<std::size_t>(i)];
    one.gap = rms_gap(fitter, one.model);
    fit_free_run(fitter, fitter.settings().rough_steps, one);
    if (one.gap < fitter.settings().damping_pays * ends.front().gap)
      fit_to_the_end(fitter, steps, one);
  });
  Start best = ends.front();
  const double most = fitter.settings().damping_pays * best.gap;
  for (Start& one : all)
    if (one.gap < std::min(most, best.gap)) best = std::move(one);
  return best;
}

}  // namespace

std::vector<Gap> gaps_of(const Fitter& fitter, const Model& model) {
  std::vector<std::optional<Gap>> all(fitter.segments().size());
  run_all(fitter.within(), static_cast<int>(all.size()), [&](int i) {
    const auto r = static_cast<std::size_t>(i);
    all[r] = free_run_gap(fitter.plant(), model, fitter.segments()[r], r, fitter.ratio(r, model));
  });
  std::vector<Gap> out;
  for (std::optional<Gap>& gap : all)
    if (gap) out.push_back(std::move(*gap));
  return out;
}

double rms_gap(const Fitter& fitter, const Model& model) {
  const std::vector<Gap> gaps = gaps_of(fitter, model);
  if (gaps.empty() || gaps.size() < fitter.segments().size()) return kDiverged;
  double sum = 0;
  for (const Gap& g : gaps) sum += g.overall * g.overall;
  return std::sqrt(sum / static_cast<double>(gaps.size()));
}

std::vector<Model> linear_starts(const Plant& plant, const Model& model) {
  Model damped = model;
  const auto elements = plant.element_count();
  damped.theta.tail(elements) = model.theta.tail(elements).cwiseMax(plant.design.tail(elements));
  Model design = model;
  design.theta = plant.design;
  return {model, damped, design};
}

JudgedFit free_run_fit(const Fitter& fitter, const std::vector<Model>& starts, int steps,
                       bool to_the_end) {
  Start best;
  for (const Model& model : starts) {
    Start one{model, rms_gap(fitter, model)};
    if (to_the_end)
      fit_to_the_end(fitter, steps, one);
    else
      fit_free_run(fitter, steps, one);
    if (best.model.theta.size() == 0 || one.gap < best.gap) best = std::move(one);
  }
  return {std::move(best.model), best.gap, false};
}

JudgedFit judged_fit(const Fitter& fitter, const std::vector<Model>& starts, int steps,
                     const Parallel& parallel) {
  const Model& first = starts.front();
  const FitResult noise = fitter.fit(first, {}, thorough(first, steps));
  const Model& fitted = noise.good ? noise.model : first;
  JudgedFit out{fitted, rms_gap(fitter, fitted), false};
  out.near_noise = noise.good && noise.total_misfit() <
                                     fitter.settings().near_noise * fitter.expected(noise.model);
  if (out.near_noise) return out;

  std::vector<Start> all{{out.model, out.gap}};
  for (const Model& model : starts) all.push_back({model, rms_gap(fitter, model)});
  sort_starts(kSameGap, all);
  run_all(parallel, static_cast<int>(all.size()), [&](int i) {
    fit_free_run(fitter, fitter.settings().rough_steps, all[static_cast<std::size_t>(i)]);
  });
  sort_starts(kSameEnd, all);
  keep_close(fitter.settings().nearly_best, all);
  if (fitter.plant().is_large()) all.resize(1);
  run_all(parallel, static_cast<int>(all.size()),
          [&](int i) { fit_to_the_end(fitter, steps, all[static_cast<std::size_t>(i)]); });
  sort_starts(kSameEnd, all);
  keep_close(fitter.settings().nearly_best, all);
  Start best = with_free_ratios(fitter, steps, all, parallel);
  out.model = std::move(best.model);
  out.gap = best.gap;
  return out;
}

}  // namespace framewatch::estimator
