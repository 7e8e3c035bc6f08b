// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/diagnose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/fit/noise_corner.h"
#include "estimator/diagnose/propose/law_kind.h"
#include "estimator/diagnose/propose/propose.h"
#include "estimator/diagnose/trials/catalogue_form.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "estimator/diagnose/trials/known_effects.h"
#include "estimator/diagnose/trials/refit.h"
#include "estimator/diagnose/trials/round_trials.h"
#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/several_causes.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trial_names.h"
#include "estimator/diagnose/trials/trials.h"
#include "estimator/diagnose/trials/wrong_labels.h"
#include "estimator/diagnose/verdict/effect_search.h"
#include "estimator/diagnose/verdict/evidence.h"
#include "estimator/diagnose/verdict/nearest_law.h"
#include "estimator/diagnose/verdict/verdict.h"

namespace framewatch::estimator {
namespace {

using Eigen::MatrixXcd;

constexpr std::size_t kOfDeformation = 4, kDissipative = 2;

bool is_dissipative(EffectKind law) {
  return is_of_kind(law, LawKind::dissipative);
}

std::vector<Proposal> select_proposals(const TrialContext& c, std::vector<Proposal> all,
                                       bool (*wanted)(EffectKind), std::size_t most) {
  std::erase_if(all, [&](const Proposal& p) { return !wanted(p.kind) || is_excluded(c, p.kind); });
  if (all.size() > most) all.resize(most);
  return all;
}

/// Returns trials that combine a law of the deformation and a dissipative law at an element, best
/// first. The elastic force of a part does not determine its damping, nor the reverse. Hysteresis
/// is both, so it is left out. context: of the model without a law there.
std::vector<Trial> trials_of_combined_laws(const TrialContext& c, const EffectPlace& element) {
  const std::optional<Localisation> here = localise_element(c.fitter, c.now, element);
  if (!here) return {};
  const std::vector<Proposal> all = propose(c.fitter, *here, 0);
  std::vector<Trial> out =
      try_together(c, *here, select_proposals(c, all, is_of_deformation, kOfDeformation),
                   select_proposals(c, all, is_dissipative, kDissipative));
  select_trial(c, here->misfit, 0, out);
  std::erase_if(out, [](const Trial& t) { return t.outcome != TrialOutcome::fitted; });
  return out;
}

class Diagnoser {
 public:
  Diagnoser(const Plant& plant, std::vector<RecordSegment>& segments,
            const DiagnosisOptions& options)
      : plant_(plant),
        segments_(segments),
        progress_(options.progress, options.parallel),
        options_(options),
        fitter_(plant, segments, options.tolerances, until_over(is_over(), options.within),
                options.settings),
        search_(fitter_, segments, options_, progress_, out_) {
    options_.parallel = until_over(is_over(), progress_.counted());
    out_.settings = options.settings;
  }

  Diagnosis run(std::vector<FoundEffect> ramps) {
    progress_.begin("linear model", 0, 0.02);
    Model start = initial_model(plant_);
    out_.known = add_known(plant_, segments_, options_.known, start);
    add_modal_damping(plant_, start);
    FitResult now = fit(start, {}, fitter_.settings().longest_steps);
    if (!now.good) {
      out_.reason = "the model cannot be fitted to these records";
      return out_;
    }
    search_.complete(now);
    search_.set_linear(now);
    search_.keep(now);
    if (!in_time(kSearchShare, [&] { search(now); })) search_.end_early(now);
    name_by_shape(search_.context_of(now), out_.effects);
    out_.ratio_after = search_.ratio(now);
    out_.noise_corner_hz = segments_.front().corner_hz;
    finish(now, ramps);
    judge(fitter_, out_);
    return out_;
  }

 private:
  /// Returns the question that ends work within in_time().
  std::function<bool()> is_over() const {
    if (!options_.is_over) return {};
    return [this] { return share_ > 0 && options_.is_over(share_); };
  }

  /// Does the work until `share` of the time has passed. Returns false if that ended it.
  template <typename Work>
  bool in_time(double share, Work work) {
    share_ = share;
    bool done = true;
    try {
      work();
    } catch (const SearchOver&) {
      done = false;
    }
    share_ = 0;
    return done;
  }

  /// Fits the models of the result and sets their errors and gaps. If the time ends, keeps the
  /// models that the search fitted.
  void finish(const FitResult& now, const std::vector<FoundEffect>& ramps) {
    const auto in_time_or_told = [&](const char* what, const std::function<void()>& work) {
      const bool done = in_time(1, work);
      if (!done) out_.not_done.emplace_back(what);
      return done;
    };
    progress_.begin("models", 0.8, 0.9);
    if (!in_time_or_told("models with masses, gains and clocks as declared",
                         [&] { set_models(now.model); }))
      out_.model = out_.declared = now.model;
    (void)in_time_or_told("errors of the values", [&] {
      set_errors(fitter_, out_.model, now.motion, out_.effects);
      set_errors(fitter_, out_.model, now.motion, out_.known);
    });
    out_.effects.insert(out_.effects.begin(), ramps.begin(), ramps.end());
    progress_.begin("gaps", 0.9, 1);
    if (!in_time_or_told("models of the training records alone",
                         [&] { set_gaps(fitter_, options_, out_); })) {
      set_gaps_of_all(fitter_, options_.holdout_from, out_);
      search_.doubt_all();  // no record that the model has not seen speaks for them
    }
    mark_approximate(fitter_, out_);
    if (ramps.empty() && withdraw_worse(fitter_.settings(), options_.holdout_from, out_) &&
        !in_time(1, [&] { set_models(out_.linear); }))
      out_.model = out_.declared = out_.linear;
    (void)in_time_or_told("laws that come near", [&] { set_leading(fitter_, options_, out_); });
  }

  /// Finds the effects. Throws SearchOver if it is over before.
  void search(FitResult& now) {
    progress_.begin("channel labels", 0.02, 0.05);
    const std::vector<Trial> labels = wrong_labels(search_.context_of(now));
    if (!labels.empty()) search_.adopt(labels, now);
    search_.begin_part(SearchPart::single);
    search_.run(now);
    search_.begin_part(SearchPart::several);
    progress_.begin("checks", 0.75, 0.8);
    withdraw_other_kind(now);
    search_.keep(now);
    const bool several = find_several(now) && !find_further(now);
    name_nearest(now);
    search_.begin_part(SearchPart::redundant);
    search_.keep(now);
    find_combined_laws(now);
    if (!out_.effects.empty() && !several) {
      remove_not_needed(fitter_, options_.parallel, out_.effects, now);
      drop_redundant(now);
      polish(now);
    }
  }

  FitResult fit(const Model& model, const std::vector<MatrixXcd>& motion, int steps) const {
    return fitter_.fit(model, motion, thorough(model, steps));
  }

  /// Removes effects in doubt, the last one first, whose removal leaves the gap as good.
  void drop_redundant(FitResult& now) {
    while (out_.effects.size() > 1) {
      const bool fits = search_.ratio(now) < 1 + chance_of(fitter_, now.model);
      if (fits && out_.effects.back().confidence > kDoubtful) return;
      const std::size_t last = out_.effects.size() - 1;
      const Model less = without_effects(now.model, out_.effects, last, last + 1, plant_);
      FitResult fitted = fit_to_the_end(fitter_, less, now.motion);
      if (!fitted.good || !is_redundant(fitter_, now.model, fitted.model, options_.parallel))
        return;
      out_.effects.pop_back();
      now = std::move(fitted);
    }
  }

  /// For a component, replaces the law by laws of two sorts if that explains a tenth of the
  /// remaining power. Hysteresis is of both sorts.
  void find_combined_laws(FitResult& now) {
    if (plant_.equations() != 1 || out_.effects.size() != 1 ||
        search_.ratio(now) < fitter_.settings().near_noise ||
        is_of_kind(out_.effects.front().chosen.kind, LawKind::hysteretic))
      return;
    FitResult linear = fit(out_.linear, {}, fitter_.settings().long_steps);
    const std::vector<Trial> trials =
        trials_of_combined_laws(search_.context_of(linear), out_.effects.front().chosen.place);
    if (trials.empty() || worsens(fitter_, trials.front(), now, 0) ||
        gap_ratio(fitter_, trials.front().model, now.model, options_.parallel) >
            fitter_.settings().pays)
      return;
    out_.effects.clear();
    search_.adopt(trials, linear);
    now = std::move(linear);
  }

  /// Fits everything once more, with the shape of hysteresis free.
  void polish(FitResult& now) {
    Model start = now.model;
    free_shapes(start);
    const FitResult better = fit_to_the_end(fitter_, start, now.motion);
    if (better.good && better.cost < now.cost) now = better;
  }

  /// Sets the models of the result. If more than noise is left, fits them by judged_fit().
  void set_models(const Model& model) {
    out_.model = model;
    std::vector<RecordSegment> segments = segments_;
    const bool judges_linear = out_.ratio_before > fitter_.settings().near_noise,
               judges = out_.ratio_after > fitter_.settings().near_noise;
    const auto judged_of = [&](const std::vector<Model>& starts) {
      return judged_fit(fitter_, starts, fitter_.settings().steps, fitter_.within());
    };
    JudgedFit linear, judged;
    run_all(options_.parallel, 2, [&](int i) {
      if (i == 0 && judges_linear) linear = judged_of(linear_starts(plant_, out_.linear));
      if (i == 1 && judges && !out_.effects.empty()) judged = judged_of({model});
    });
    if (judges_linear) out_.linear = linear.model;
    if (judges) {
      if (out_.effects.empty()) judged = judges_linear ? linear : judged_of({out_.linear});
      out_.model = judged.model;
      segments = with_model_error(plant_, segments_, std::min(judged.gap, 1.0));
    }
    out_.declared = declared_model(plant_, segments, out_.model, {&out_.known, &out_.effects},
                                   fitter_.within());
  }

  /// Withdraws a law if more than noise is left and its place needs another kind of force.
  void withdraw_other_kind(FitResult& now) {
    const double excess = search_.ratio(now) - 1;
    if (out_.effects.size() != 1 || excess < chance_of(fitter_, now.model) ||
        !contradicts_the_kind(fitter_.settings(), out_.effects.front().chosen, out_.where,
                              excess / std::max(out_.ratio_before - 1, excess)))
      return;
    out_.rejected = std::move(out_.effects.front().alternatives);
    out_.rejected.insert(out_.rejected.begin(), std::move(out_.effects.front().chosen));
    out_.effects.clear();
    now = fit(out_.linear, {}, fitter_.settings().long_steps);
  }

  /// If nothing is named and no place explains the misfit alone, searches for causes that act at
  /// once.
  bool find_several(FitResult& now) {
    if (!out_.effects.empty() || search_.alone() < fitter_.settings().one_place ||
        fits_separately(fitter_, out_.linear, out_.ratio_before))
      return false;
    SeveralCauses several =
        several_causes(search_.context_of(now), out_.rejected, options_.holdout_from);
    if (several.causes.empty()) return false;
    const FitResult together = fit(several.model, {}, 0);
    if (!together.good) return false;
    auto next = static_cast<int>(now.model.effects.size());
    for (Cause& cause : several.causes) {
      FoundEffect found;
      found.chosen = std::move(cause.trial);
      found.chosen.model = several.model;
      found.chosen.fraction = std::numeric_limits<double>::quiet_NaN();
      found.like = std::move(cause.like);
      found.confidence = kDoubtful;
      found.index = is_axis_error(found.chosen.kind) ? -1 : next++;
      found.alternatives = out_.rejected;
      out_.effects.push_back(std::move(found));
    }
    out_.trained = std::move(several.model);
    now = together;
    return true;
  }

  /// Searches for a further effect once several causes explain most of the misfit.
  bool find_further(FitResult& now) {
    if (plant_.is_large() ||
        search_.ratio(now) - 1 > (1 - fitter_.settings().explains_most) * (out_.ratio_before - 1))
      return false;
    const Diagnosis before = out_;
    const double corner_hz = segments_.front().corner_hz;
    FitResult with = fit_to_the_end(fitter_, now.model, now.motion);
    if (!with.good) return false;
    search_.complete(with);
    search_.rounds(with, out_.effects.size());
    if (out_.effects.size() <= before.effects.size()) {
      out_ = before;
      set_corner(corner_hz, segments_);
      return false;
    }
    search_.doubt_all();
    out_.trained.reset();
    now = std::move(with);
    return true;
  }

  /// If no law explains enough, names the nearest one.
  void name_nearest(FitResult& now) {
    if (!out_.effects.empty() || !out_.reason.empty() ||
        !nearest_law_first(search_.context_of(now), out_.where, out_.rejected) ||
        fits_separately(fitter_, out_.linear, out_.ratio_before))
      return;
    search_.adopt(std::exchange(out_.rejected, {}), now);
    out_.effects.front().confidence = std::min(out_.effects.front().confidence, kDoubtful);
    out_.effects.front().nearest = true;
    search_.complete(now);
  }

  const Plant& plant_;
  std::vector<RecordSegment>& segments_;  ///< with the corner frequency of their noise
  SearchProgress progress_;
  double share_ = 0;          ///< DiagnosisOptions::is_over is asked with it; 0: not asked
  DiagnosisOptions options_;  ///< `parallel` reports progress
  Fitter fitter_;
  Diagnosis out_;
  EffectSearch search_;
};

}  // namespace

Diagnosis diagnose(const Plant& plant, const std::vector<RecordSegment>& segments,
                   const DiagnosisOptions& options) {
  std::vector<RecordSegment> straight = segments;
  const std::vector<FoundEffect> ramps = remove_ramps(plant, options, straight);
  Diagnosis out = Diagnoser(plant, straight, options).run(ramps);
  out.evidence = evidence_of(plant, straight, options.holdout_from, out);
  add_ramps_to_gaps(plant, straight, options.holdout_from, out);
  return out;
}

}  // namespace framewatch::estimator
