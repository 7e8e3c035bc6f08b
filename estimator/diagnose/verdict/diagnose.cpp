#include "estimator/diagnose/verdict/diagnose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/fit/model_error.h"
#include "estimator/diagnose/fit/noise_colour.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "estimator/diagnose/trials/declared.h"
#include "estimator/diagnose/trials/implausible_masses.h"
#include "estimator/diagnose/trials/known_effects.h"
#include "estimator/diagnose/trials/needless.h"
#include "estimator/diagnose/trials/parameter_errors.h"
#include "estimator/diagnose/trials/round_trials.h"
#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/several_causes.h"
#include "estimator/diagnose/trials/trial_names.h"
#include "estimator/diagnose/trials/trial_relations.h"
#include "estimator/diagnose/trials/wrong_labels.h"
#include "estimator/diagnose/verdict/nearest_law.h"
#include "estimator/diagnose/verdict/ramps.h"
#include "estimator/diagnose/verdict/search_progress.h"
#include "estimator/diagnose/verdict/verdict.h"
#include "estimator/diagnose/verdict/where.h"

namespace framewatch::estimator {
namespace {

using Eigen::MatrixXcd;

/// Fraction above which a second law at the place of the first does not call the first in question.
constexpr double kOneLaw = 0.99;
constexpr double kClearer = 0.7;  ///< excess of a place's misfit over that of another search
constexpr int kPolishSteps = 6, kBackSteps = 8;

class Search {
 public:
  Search(const Plant& plant, std::vector<RecordSegment>& segments, const DiagnosisOptions& options)
      : plant_(plant),
        segments_(segments),
        progress_(options.progress, options.parallel),
        options_(options),
        fitter_(plant, segments, options.tolerances) {
    options_.parallel = progress_.counted();
  }

  Diagnosis run(std::vector<FoundEffect> ramps) {
    progress_.begin("linear model", 0, 0.02);
    Model start = initial_model(plant_);
    out_.known = add_known(plant_, segments_, options_.known, start);
    add_modal_damping(plant_, start);
    FitResult now = fit(start, {}, 12);
    if (!now.good) {
      out_.reason = "the model cannot be fitted to these records";
      return out_;
    }
    complete(now);
    set_linear(now);
    progress_.begin("labels", 0.02, 0.05);
    const std::vector<Trial> labels = wrong_labels(context_of(now));
    if (!labels.empty()) adopt(labels, now);
    search(now);
    if (out_.effects.empty()) search_with_free_damping(now);
    progress_.begin("what stays", 0.75, 0.8);
    withdraw_other_kind(now);
    const bool several = find_several(now);
    if (!several) name_nearest(now);
    if (!out_.effects.empty() && !several) polish(now);
    name_by_shape(context_of(now), out_.effects);
    out_.ratio_after = ratio(now);
    out_.noise_corner_hz = segments_.front().corner_hz;
    progress_.begin("models", 0.8, 0.9);
    set_models(now.model);
    mark_approximate(fitter_, out_);
    set_errors(fitter_, out_.model, now.motion, out_.effects);
    set_errors(fitter_, out_.model, now.motion, out_.known);
    out_.effects.insert(out_.effects.begin(), ramps.begin(), ramps.end());
    progress_.begin("gaps", 0.9, 1);
    set_gaps(fitter_, options_, out_);
    if (ramps.empty() && withdraw_worse(options_.holdout_from, out_)) set_models(out_.linear);
    set_leading(fitter_, options_, out_);
    judge(fitter_, out_);
    return out_;
  }

 private:
  FitResult fit(const Model& model, const std::vector<MatrixXcd>& motion, int steps) const {
    return fitter_.fit(model, motion, thorough(model, steps));
  }

  void search(FitResult& now) {
    bool more = true;
    for (int round = 0; round < options_.rounds && more; ++round) {
      more = one_round(now, static_cast<std::size_t>(round));
      if (more) complete(now);
    }
  }

  /// What is missing may hide the form of the damping, and that what is missing: once more with
  /// ratios that need not be worth their price until something is found.
  void search_with_free_damping(FitResult& now) {
    FitResult free = with_free_damping(fitter_, now);
    if (!free.good) return;
    Diagnosis before = out_;
    out_.where.clear();
    to_beat_ = alone_;
    search(free);
    if (!out_.effects.empty()) {
      now = std::move(free);
      return;
    }
    out_ = std::move(before);
    alone_ = to_beat_;
  }

  /// What no effect stands for: the form of the damping, and the colour of the noise.
  void complete(FitResult& now) {
    FitResult with = with_free_damping(fitter_, now);
    if (with.good && out_.effects.empty() && one_damper_does(context_of(now), with)) with = now;
    if (with.good && colour_noise(fitter_, segments_, with)) now = with;
    settle_damping(fitter_, std::move(with), now);
    colour_noise(fitter_, segments_, now);
  }

  void set_linear(const FitResult& now) {
    out_.linear = now.model;
    out_.ratio_before = ratio(now);
  }

  double ratio(const FitResult& now) const {
    return now.total_misfit() / fitter_.expected(now.model);
  }

  /// Fits everything once more, with the shape of hysteresis free.
  void polish(FitResult& now) {
    Model start = now.model;
    free_shapes(start);
    const FitResult better = fit_to_the_end(fitter_, start, now.motion);
    if (better.good && better.cost < now.cost) now = better;
  }

  TrialContext context_of(const FitResult& now) const {
    return {fitter_, now, options_.without, options_.parallel,
            [this](const std::string& what) { progress_.say(what); }};
  }

  /// The models of the result. Where more than noise is left they are fitted to what they are
  /// judged by.
  void set_models(const Model& model) {
    out_.model = model;
    std::vector<RecordSegment> segments = segments_;
    if (out_.ratio_before > kNearNoise)
      out_.linear =
          judged_fit(fitter_, linear_starts(plant_, out_.linear), kPolishSteps, options_.parallel)
              .model;
    if (out_.ratio_after > kNearNoise) {
      const JudgedFit judged = judged_fit(fitter_, {out_.effects.empty() ? out_.linear : model},
                                          kPolishSteps, options_.parallel);
      out_.model = judged.model;
      segments = with_model_error(plant_, segments_, std::min(judged.gap, 1.0));
    }
    out_.declared = declared_model(plant_, segments, out_.model, {&out_.known, &out_.effects});
  }

  bool one_round(FitResult& now, std::size_t round) {
    const RoundShares& shares = kRounds[std::min<std::size_t>(round, std::size(kRounds) - 1)];
    progress_.begin("where", shares.where, shares.trials, {0.4, 0.35});
    Located located = locate(fitter_, now, options_.parallel);
    relocate_beside(context_of(now), out_.effects, located);
    if (located.places.empty()) return false;
    const Localisation& place = located.places.front();
    if (place.ratio - 1 > kClearer * (to_beat_ - 1)) return false;
    alone_ = place.ratio;
    const double expected_now = fitter_.expected(now.model);
    const double excess = now.total_misfit() - std::clamp(place.ratio, 0.5, 1.0) * expected_now;
    if (out_.where.empty()) {
      out_.where = where_of(fitter_, located.places);
      out_.map = map_of(located);
    }
    const double needed = std::max(kLeastGain, kSignificant * std::sqrt(expected_now));
    if (excess < needed) return find_mass(now, located);
    // Beside laws that fit, a small rest is a linear effect or the shape of these laws: no further
    // law.
    const bool small = !out_.effects.empty() && ratio(now) < kAdequate;
    if (small && is_element(place)) return false;
    std::vector<Trial> trials;
    double bound = std::min(now.cost, bound_of(plant_, place));
    const bool pairs = place.ratio > kOnePlace;
    const TrialContext context = context_of(now);
    if (pairs) {
      progress_.begin("two places", shares.trials, shares.laws());
      trials = trials_of_pairs(context, located, bound);
    }
    progress_.begin("laws", shares.trials, shares.end, {0.05, 0.2, 0.2, 0.2});
    append(trials, trials_of_places(context, located, small));
    bool holds = select_trial(context, bound, needed, trials);
    // Several forces at one place may be those of two effects.
    if (!holds && !pairs && place.candidate_places.front().size() > 1) {
      append(trials, trials_of_pairs(context, located, bound));
      holds = select_trial(context, bound, needed, trials);
    }
    if (!holds) {
      append(trials, trials_of_whole_frame(context, located));
      holds = select_trial(context, bound, needed, trials);
    }
    if (trials.empty() || trials.front().outcome != TrialOutcome::fitted) return false;
    if (!holds) {
      out_.rejected = without_duplicates(trials);
      return false;
    }
    const Trial& best = trials.front();
    for (std::size_t i = 0; i < out_.effects.size(); ++i) {
      const FoundEffect& earlier = out_.effects[i];
      if (!same_spot(earlier.chosen.place, best.place)) continue;
      // Two laws at one place are a single law that the catalogue does not have.
      const bool whole = earlier.chosen.place.kind == PlaceKind::whole_frame;
      if (earlier.chosen.fraction < kOneLaw && plant_.equations() > 1 && !whole) withdraw(now, i);
      return false;
    }
    adopt(trials, now);
    return true;
  }

  bool find_mass(FitResult& now, const Located& located) {
    std::vector<Trial> trials = implausible_masses(context_of(now), located);
    std::erase_if(trials, [&](const Trial& t) { return worsens(t, now, kImplausibleMasses); });
    if (trials.empty()) return false;
    adopt(trials, now);
    return true;
  }

  /// A law is none beside which more than noise is left and whose place needs another sort of
  /// force.
  void withdraw_other_kind(FitResult& now) {
    const double excess = ratio(now) - 1;
    if (out_.effects.size() != 1 || excess < chance_of(fitter_, now.model) ||
        !contradicts_the_kind(out_.effects.front().chosen, out_.where,
                              excess / std::max(out_.ratio_before - 1, excess)))
      return;
    out_.rejected = std::move(out_.effects.front().alternatives);
    out_.rejected.insert(out_.rejected.begin(), std::move(out_.effects.front().chosen));
    out_.effects.clear();
    now = fit(out_.linear, {}, kBackSteps);
  }

  /// Where nothing is named and no place explains the misfit alone: causes that act at once.
  bool find_several(FitResult& now) {
    if (!out_.effects.empty() || alone_ < kOnePlace ||
        fits_separately(fitter_, out_.linear, out_.ratio_before))
      return false;
    SeveralCauses several = several_causes(context_of(now), out_.rejected, options_.holdout_from);
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

  /// Where no law explains enough to hold: the one that is near.
  void name_nearest(FitResult& now) {
    if (!out_.effects.empty() || !out_.reason.empty() ||
        !nearest_law_first(context_of(now), out_.where, out_.rejected) ||
        fits_separately(fitter_, out_.linear, out_.ratio_before))
      return;
    adopt(std::exchange(out_.rejected, {}), now);
    out_.effects.front().confidence = std::min(out_.effects.front().confidence, kDoubtful);
    out_.effects.front().nearest = true;
    complete(now);
  }

  /// Goes back to the model before the effect `first` was added.
  void withdraw(FitResult& now, std::size_t first) {
    out_.reason = "no single law of the catalogue is what acts at " +
                  place_text(out_.effects[first].chosen.place, plant_.structure, plant_.axes);
    out_.rejected.clear();
    for (std::size_t i = first; i < out_.effects.size(); ++i)
      out_.rejected.push_back(out_.effects[i].chosen);
    out_.effects.resize(first);
    now = fit(first == 0 ? out_.linear : out_.effects.back().chosen.model, {}, kBackSteps);
    if (first > 0) complete(now);
  }

  void adopt(const std::vector<Trial>& trials, FitResult& now) {
    const std::size_t known = out_.effects.size();
    const Trial& best = trials.front();
    FoundEffect found = effect_of(trials);
    auto next = static_cast<int>(now.model.effects.size());
    const auto place = [&](FoundEffect& effect) {
      effect.index = is_axis_error(effect.chosen.kind) ? -1 : next++;
    };
    FoundEffect other = found;
    place(found);
    out_.effects.push_back(std::move(found));
    if (best.second) {
      other.chosen.kind = best.second->first;
      other.chosen.place = best.second->second;
      place(other);
      out_.effects.push_back(std::move(other));
    }
    const Model before = now.model;
    now = fit_to_the_end(fitter_, best.model, now.motion);
    // Trials of a large building hold its masses: what these explain looks like the effect.
    if ((known > 0 || plant_.is_large()) && removes_needless(fitter_, before, now)) {
      out_.effects.resize(known);
      if (known == 0) set_linear(now);
      return;
    }
    remove_needless_earlier(fitter_, out_.effects, now);
  }

  const Plant& plant_;
  std::vector<RecordSegment>& segments_;  ///< their noise is coloured
  mutable SearchProgress progress_;
  DiagnosisOptions options_;  ///< `parallel` tells the progress
  Fitter fitter_;
  Diagnosis out_;
  double to_beat_ = 1e300;  ///< `alone_` of another search
  double alone_ = 0;        ///< Localisation::ratio of the likeliest place, in the last round
};

}  // namespace

Diagnosis diagnose(const Plant& plant, const std::vector<RecordSegment>& segments,
                   const DiagnosisOptions& options) {
  std::vector<RecordSegment> straight = segments;
  const std::vector<FoundEffect> ramps = remove_ramps(plant, options, straight);
  Diagnosis out = Search(plant, straight, options).run(ramps);
  add_ramps_to_gaps(plant, straight, options.holdout_from, out);
  return out;
}

}  // namespace framewatch::estimator
