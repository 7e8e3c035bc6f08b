// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/effect_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "estimator/diagnose/fit/noise_corner.h"
#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "estimator/diagnose/trials/implausible_masses.h"
#include "estimator/diagnose/trials/refit.h"
#include "estimator/diagnose/trials/round_trials.h"
#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trial_names.h"
#include "estimator/diagnose/verdict/diagnosis.h"
#include "estimator/diagnose/verdict/verdict.h"

namespace framewatch::estimator {
namespace {

/// Returns the reduction of the cost that is more than chance.
double needed_of(const Fitter& fitter, const Model& model) {
  return std::max(fitter.settings().min_gain,
                  fitter.settings().significant * std::sqrt(fitter.expected(model)));
}

/// Returns the trials with which another effect may act. trials: best first.
std::vector<Trial> leads_of(const SearchSettings& settings, const std::vector<Trial>& trials) {
  std::vector<Trial> out;
  for (const Trial& t : without_duplicates(trials)) {
    if (t.outcome != TrialOutcome::fitted || t.second || t.fraction < settings.promises ||
        t.kind == EffectKind::unmeasured_force)
      continue;
    out.push_back(t);
    if (out.size() == settings.finalists) break;
  }
  return out;
}

/// Words for SearchPart, in its order.
constexpr std::array kPartWords = {
    "exchanged and reversed channels",
    "effects one after the other",
    "two effects, neither of which is found without the other",
    "effects with free damping of the modes",
    "rivals in place of the effects found",
    "several effects that act at once",
    "effects that are not needed",
};

}  // namespace

Parallel until_over(std::function<bool()> is_over, Parallel parallel) {
  if (!is_over) return parallel;
  return [is_over = std::move(is_over), parallel = std::move(parallel)](
             int count, const std::function<void(int)>& work) {
    run_all(parallel, count, [&](int i) {
      if (is_over()) throw SearchOver();
      work(i);
    });
  };
}

std::vector<std::string> parts_not_done(SearchPart part) {
  return {kPartWords.begin() + static_cast<std::ptrdiff_t>(part), kPartWords.end()};
}

SearchProgress::SearchProgress(ReportProgress report, Parallel parallel)
    : report_(std::move(report)), parallel_(std::move(parallel)) {}

void SearchProgress::begin(const std::string& what, double from, double to,
                           std::vector<double> calls) {
  from_ = done_ = std::max(from, done_);
  to_ = std::max(to, from_);
  calls_ = std::move(calls);
  call_ = 0;
  describe(what);
}

void SearchProgress::describe(const std::string& what) {
  what_ = what;
  report(done_);
}

Parallel SearchProgress::counted() {
  return [this](int count, const std::function<void(int)>& work) { run(count, work); };
}

void SearchProgress::run(int count, const std::function<void(int)>& work) {
  const double left = to_ - done_;
  const double part =
      call_ < calls_.size() ? std::min(calls_[call_] * (to_ - from_), left) : left / 2;
  ++call_;
  report(done_ + part);
  run_all(parallel_, count, work);
  done_ += part;
  report(done_);
}

void SearchProgress::report(double then) const {
  if (report_) report_(what_, done_, then);
}

void EffectSearch::run(FitResult& now) {
  const FitResult linear = now;
  const double corner_hz = segments_.front().corner_hz;
  rounds(now, 0);
  // A component has one place; in a large building every round takes long.
  const bool more = fitter_.plant().equations() > 1 && !fitter_.plant().is_large();
  begin_part(SearchPart::two_at_once);
  if (more && out_.effects.empty()) look_ahead(now);
  begin_part(SearchPart::free_damping);
  if (out_.effects.empty()) search_with_free_damping(now);
  begin_part(SearchPart::rivals);
  if (more) replace_laws(now);
  out_.noise_by_place = by_place_ && !out_.effects.empty();
  if (!out_.effects.empty()) return;
  set_corner(corner_hz, segments_);
  now = linear;
  set_linear(now);
}

/// Compares the laws again with everything found since. If one is replaced, searches its residual.
void EffectSearch::replace_laws(FitResult& now) {
  bool another = false;
  for (FoundEffect& effect : out_.effects)
    another |= choose_replacement(context_of(now), effect, now);
  if (!another) return;
  complete(now);
  rounds(now, out_.effects.size());
}

void EffectSearch::rounds(FitResult& now, std::size_t first) {
  for (std::size_t round = first; round < static_cast<std::size_t>(options_.rounds); ++round) {
    const bool found = one_round(now, round);
    if (found) complete(now);
    if (!provisional_) keep(now);
    if (!found) return;
  }
}

void EffectSearch::keep(const FitResult& now) {
  kept_ = {out_, now, segments_.front().corner_hz};
}

void EffectSearch::end_early(FitResult& now) {
  // The places of the present round are known before its trials are compared.
  std::vector<WhereEntry> where = std::move(out_.where), map = std::move(out_.map);
  out_ = kept_->out;
  now = kept_->now;
  set_corner(kept_->corner_hz, segments_);
  if (out_.where.empty()) {
    out_.where = std::move(where);
    out_.map = std::move(map);
  }
  out_.not_done = parts_not_done(part_);
  doubt_all();
  if (!out_.effects.empty() || !out_.rejected.empty()) return;
  std::erase_if(fitted_, [](const Trial& t) { return t.outcome != TrialOutcome::fitted; });
  std::stable_sort(fitted_.begin(), fitted_.end(),
                   [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
  const double to_explain = now.cost - fitter_.expected(now.model);
  for (Trial& t : fitted_) t.fraction = (now.cost - t.cost) / std::max(to_explain, 1.0);
  out_.rejected = without_duplicates(fitted_);
}

/// A missing effect and the form of the damping may hide each other. Searches again with free
/// damping ratios, which need not justify their price until something is found.
void EffectSearch::search_with_free_damping(FitResult& now) {
  FitResult free = with_free_damping(fitter_, now);
  if (!free.good) return;
  Diagnosis before = out_;
  out_.where.clear();
  to_beat_ = alone_;
  provisional_ = true;
  rounds(free, 0);
  provisional_ = false;
  if (!out_.effects.empty()) {
    now = std::move(free);
    return;
  }
  out_ = std::move(before);
  alone_ = to_beat_;
}

/// Searches for two effects, neither of which is accepted without the other. Assumes each of the
/// best laws provisionally, and keeps it if another is found and little is left.
void EffectSearch::look_ahead(FitResult& now) {
  const Diagnosis before = out_;
  const double alone = alone_;
  const double corner_hz = segments_.front().corner_hz;
  provisional_ = true;
  for (const Trial& lead : leads_of(fitter_.settings(), before.rejected)) {
    FitResult with = now;
    if (explains_with_second(lead, with)) {
      now = std::move(with);
      break;
    }
    out_ = before;
    alone_ = alone;
    set_corner(corner_hz, segments_);
  }
  provisional_ = false;
}

bool EffectSearch::explains_with_second(const Trial& lead, FitResult& now) {
  std::vector<Trial> trials = out_.rejected;
  const auto at = std::find_if(trials.begin(), trials.end(), [&](const Trial& t) {
    return t.kind == lead.kind && t.place == lead.place && !t.second;
  });
  std::rotate(trials.begin(), at, at + 1);
  out_.rejected.clear();
  const double before = ratio(now);
  before_lead_ = now.cost;
  adopt(trials, now);
  if (!out_.effects.empty()) {
    const bool here = find_second_law_at(lead, now);
    if (here) complete(now);
    rounds(now, here ? 2 : 1);
  }
  before_lead_ = 0;
  if (out_.effects.size() < 2 || ratio(now) - 1 > (1 - fitter_.settings().explains) * (before - 1))
    return false;
  doubt_all();
  return true;
}

/// Adds a time-varying law to a law of the motion at the same place, or the reverse.
bool EffectSearch::find_second_law_at(const Trial& lead, FitResult& now) {
  const std::optional<Localisation> here = localise_element(fitter_, now, lead.place);
  if (!here || here->ratio > fitter_.settings().one_place) return false;
  const TrialContext context = context_of(now);
  std::vector<Trial> trials = try_places(context, {*here}, [&](EffectKind kind) {
    return changes_with_time(kind) != changes_with_time(lead.kind);
  });
  const double bound = std::min(now.cost, bound_of(fitter_.plant(), *here));
  return accepts(context, bound, needed_of(fitter_, now.model), trials) &&
         adopt_accepted(trials, now);
}

/// Returns true if the best of the trials explains enough, together with a provisional law.
bool EffectSearch::accepts(const TrialContext& context, double bound, double needed,
                           std::vector<Trial>& trials) {
  if (select_trial(context, bound, needed, trials)) return true;
  if (before_lead_ == 0 || trials.empty()) return false;
  const Trial& best = trials.front();
  return best.outcome == TrialOutcome::fitted &&
         before_lead_ - best.cost > fitter_.settings().explains * (before_lead_ - bound) &&
         best.fraction > fitter_.settings().explains_much &&
         !worsens(fitter_, best, context.now, needed);
}

void EffectSearch::complete(FitResult& now) {
  const double by_place_hz = segments_.front().corner_hz;
  if (by_place_hz > 0) fit_with_corner(0, now);
  FitResult with = with_free_damping(fitter_, now);
  if (with.good && out_.effects.empty() && one_damper_does(context_of(now), with)) with = now;
  if (with.good && fit_noise_corner(fitter_, segments_, with)) now = with;
  settle_damping(fitter_, std::move(with), now);
  fit_noise_corner(fitter_, segments_, now);
  by_place_ = segments_.front().corner_hz == 0 && by_place_hz > 0 &&
              ratio(now) > fitter_.settings().to_explain;
  if (by_place_) fit_with_corner(by_place_hz, now);
}

void EffectSearch::fit_with_corner(double corner_hz, FitResult& now) {
  set_corner(corner_hz, segments_);
  const FitResult again =
      fitter_.fit(now.model, now.motion, thorough(now.model, fitter_.settings().long_steps));
  if (again.good) now = again;
}

/// Estimates the noise before all effects are known, from the residual with arbitrary signals at
/// the likeliest place.
void EffectSearch::set_noise_by_place(FitResult& now, Located& located) {
  const Plant& plant = fitter_.plant();
  if (plant.unread.cols() > 0 || plant.equations() < 2 || located.places.empty() ||
      located.places.front().ratio < fitter_.settings().to_explain ||
      located.places.front().ratio > fitter_.settings().noise_at_place ||
      !set_noise_corner_at(fitter_, segments_, located.places.front()))
    return;
  by_place_ = true;
  fit_with_corner(segments_.front().corner_hz, now);
  if (out_.effects.empty()) set_linear(now);
  located = locate(fitter_, now, options_.parallel);
}

double EffectSearch::ratio(const FitResult& now) const {
  return now.total_misfit() / fitter_.expected(now.model);
}

TrialContext EffectSearch::context_of(const FitResult& now) {
  return {fitter_,
          now,
          options_.without,
          options_.parallel,
          [this](const std::string& what) { progress_.describe(what); },
          provisional_ ? nullptr : &fitted_};
}

bool EffectSearch::one_round(FitResult& now, std::size_t round) {
  fitted_.clear();
  const RoundShares& shares = kRounds[std::min<std::size_t>(round, std::size(kRounds) - 1)];
  progress_.begin("places", shares.where, shares.trials, {0.4, 0.35});
  Located located = locate(fitter_, now, options_.parallel);
  set_noise_by_place(now, located);
  relocate_beside(context_of(now), out_.effects, located);
  if (located.places.empty()) return false;
  const Localisation& place = located.places.front();
  if (place.ratio - 1 > fitter_.settings().clearer * (to_beat_ - 1)) return false;
  alone_ = place.ratio;
  const double expected_now = fitter_.expected(now.model);
  // No law of one place explains more than an arbitrary force at the best one.
  const double excess = now.total_misfit() - std::max(place.ratio, 0.5) * expected_now;
  if (out_.where.empty()) {
    out_.where = where_of(fitter_, located.places);
    out_.map = map_of(located);
  }
  const double needed = needed_of(fitter_, now.model);
  if (excess < needed) return find_mass(now, located);
  // If the laws fit, a small rest is a linear effect or the shape of these laws, not a further law.
  const bool small = !out_.effects.empty() && ratio(now) < fitter_.settings().adequate;
  if (small && is_element(place)) return false;
  bool found = false;
  const std::vector<Trial> trials = trials_of(now, located, round, small, found);
  if (trials.empty() || trials.front().outcome != TrialOutcome::fitted) return false;
  if (found) return adopt_accepted(trials, now);
  out_.rejected = without_duplicates(trials);
  return false;
}

/// Returns the trials of a round, best first. found: set to true if the best one is accepted.
std::vector<Trial> EffectSearch::trials_of(const FitResult& now, const Located& located,
                                           std::size_t round, bool small, bool& found) {
  const RoundShares& shares = kRounds[std::min<std::size_t>(round, std::size(kRounds) - 1)];
  const Localisation& place = located.places.front();
  const double needed = needed_of(fitter_, now.model);
  std::vector<Trial> trials;
  double bound = std::min(now.cost, bound_of(fitter_.plant(), place));
  const bool pairs = place.ratio > fitter_.settings().one_place;
  const TrialContext context = context_of(now);
  if (pairs) {
    progress_.begin("pairs of places", shares.trials, shares.laws());
    trials = trials_of_pairs(context, located, needed, bound);
  }
  found = leaves_less(trials, bound_of(fitter_.plant(), place) - needed) &&
          accepts(context, bound, needed, trials);
  if (!found) {
    progress_.begin("laws", shares.trials, shares.end, {0.05, 0.2, 0.2, 0.2});
    append(trials, trials_of_places(context, located, small));
    found = accepts(context, bound, needed, trials);
  }
  // Several forces at one place may be those of two effects.
  if (!found && !pairs && place.candidate_places.front().size() > 1) {
    append(trials, trials_of_pairs(context, located, needed, bound));
    found = accepts(context, bound, needed, trials);
  }
  if (!found) {
    append(trials, trials_of_whole_frame(context, located, -1));
    found = accepts(context, bound, needed, trials);
  } else if (const int frame = common_frame(trials.front()); frame >= 0) {
    // One cause rather than two: a law of a whole frame is not a coincidence in each of its
    // stories.
    std::vector<Trial> whole = trials_of_whole_frame(context, located, frame);
    const bool one = accepts(context, bound, needed, whole);
    append(trials, whole);
    if (one) std::rotate(trials.begin(), trials.end() - std::ssize(whole), trials.end());
  }
  return trials;
}

/// Adopts the best accepted trial, unless it is a second law at the place of an earlier one. A
/// time-varying law and a law of the motion may share a place.
bool EffectSearch::adopt_accepted(const std::vector<Trial>& trials, FitResult& now) {
  const Trial& best = trials.front();
  for (std::size_t i = 0; i < out_.effects.size(); ++i) {
    const FoundEffect& earlier = out_.effects[i];
    if (!same_spot(earlier.chosen.place, best.place) ||
        changes_with_time(earlier.chosen.kind) != changes_with_time(best.kind))
      continue;
    // Two laws at one place are a single law that the catalog lacks.
    const bool whole = earlier.chosen.place.kind == PlaceKind::whole_frame;
    if (earlier.chosen.fraction < fitter_.settings().sharp && fitter_.plant().equations() > 1 &&
        !whole)
      withdraw(now, i);
    return false;
  }
  adopt(trials, now);
  return true;
}

bool EffectSearch::find_mass(FitResult& now, const Located& located) {
  std::vector<Trial> trials = implausible_masses(context_of(now), located);
  std::erase_if(trials, [&](const Trial& t) {
    return worsens(fitter_, t, now, fitter_.settings().implausible_masses);
  });
  if (trials.empty()) return false;
  adopt(trials, now);
  return true;
}

/// Returns to the model before the effect `first` was added.
void EffectSearch::withdraw(FitResult& now, std::size_t first) {
  const Plant& plant = fitter_.plant();
  out_.reason = "no single law of the catalog explains the force at " +
                place_text(out_.effects[first].chosen.place, plant.structure, plant.axes);
  out_.rejected.clear();
  for (std::size_t i = first; i < out_.effects.size(); ++i)
    out_.rejected.push_back(out_.effects[i].chosen);
  out_.effects.resize(first);
  const Model& model = first == 0 ? out_.linear : out_.effects.back().chosen.model;
  now = fitter_.fit(model, {}, thorough(model, fitter_.settings().long_steps));
  if (first > 0) complete(now);
}

void EffectSearch::adopt(const std::vector<Trial>& trials, FitResult& now) {
  const std::size_t known = out_.effects.size();
  const Trial& best = trials.front();
  FoundEffect found = effect_of(fitter_.settings(), trials);
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
  // Trials of a large building hold its masses, so an effect of the masses looks like the trial's
  // effect.
  if ((known > 0 || fitter_.plant().is_large()) && remove_redundant(fitter_, before, now)) {
    out_.effects.resize(known);
    if (known == 0) set_linear(now);
    return;
  }
  remove_earlier_redundant(fitter_, out_.effects, now);
}

}  // namespace framewatch::estimator
