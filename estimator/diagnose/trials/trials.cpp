// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/trials.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/fit/free_run_start.h"
#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/propose/propose.h"
#include "estimator/diagnose/trials/trial_names.h"

namespace framewatch::estimator {
namespace {

/// A start model and the names of its new effects.
struct Candidate {
  Model model;
  std::vector<Eigen::MatrixXcd> motion;
  EffectKind kind;
  EffectPlace place;
  std::optional<std::pair<EffectKind, EffectPlace>> second;
  std::size_t from = 0;  ///< index of its place
};

struct Fitted {
  FitResult fit;
  const Candidate* candidate;
};

FitOptions full_fit(const SearchSettings& settings, const Model& model) {
  FitOptions options;
  options.forcing = forcing_of(model);
  options.max_steps =
      options.forcing == Forcing::simulated ? settings.long_steps : settings.longest_steps;
  return options;
}

Trial trial_of(const TrialContext& c, const Candidate& candidate, const FitResult& fit,
               TrialOutcome outcome) {
  Trial out;
  out.outcome = outcome;
  out.kind = candidate.kind;
  out.place = candidate.place;
  out.second = candidate.second;
  set_fit(c, fit, out);
  return out;
}

/// Returns the candidates that get a free run: the best of each place, and as many with allowed
/// names. Leaves out those that explain nothing if others explain something. Adds the rest to
/// `screened_out`.
std::vector<Fitted> worth_a_free_run(const TrialContext& c, std::vector<Fitted> first,
                                     std::vector<Trial>& screened_out) {
  std::stable_sort(first.begin(), first.end(), [](const Fitted& a, const Fitted& b) {
    return a.candidate->from != b.candidate->from ? a.candidate->from < b.candidate->from
                                                  : a.fit.cost < b.fit.cost;
  });
  std::vector<Fitted> out;
  double least = c.now.cost;
  for (const Fitted& f : first) least = std::min(least, f.fit.cost);
  const bool found = least < c.settings().leaves_little * c.now.cost;
  const std::size_t most = c.settings().finalists;
  std::size_t place = 0, of_place = 0, named_of_place = 0;
  for (Fitted& f : first) {
    if (f.candidate->from != place) of_place = named_of_place = 0;
    place = f.candidate->from;
    Trial driven = trial_of(c, *f.candidate, f.fit, TrialOutcome::screened_out);
    const bool named = may_be_named(c, driven);
    const bool nothing = found && f.fit.cost > c.settings().useless * c.now.cost;
    if (nothing ||
        (!f.candidate->second && of_place >= most && (!named || named_of_place >= most))) {
      screened_out.push_back(std::move(driven));
      continue;
    }
    ++of_place;
    named_of_place += named;
    out.push_back(std::move(f));
  }
  return out;
}

bool ends_with_friction(const Model& model) {
  return !model.effects.empty() && model.effects.back().form == LawForm::friction;
}

/// Fits friction of elements from separate start values, because measured motion may mislead its
/// fit.
void refit_friction(const TrialContext& c, const std::vector<Candidate>& candidates,
                    std::vector<Fitted>& kept, std::vector<FitResult>& runs) {
  std::vector<Fitted> anew(candidates.size());
  run_all(c.parallel, static_cast<int>(candidates.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const Candidate& candidate = candidates[at];
    if (candidate.second || !ends_with_friction(candidate.model)) return;
    anew[at].candidate = &candidate;
    for (const FitResult& from : friction_starts(c.fitter, candidate.model)) {
      FitOptions options = full_fit(c.settings(), from.model);
      options.max_steps = c.settings().longest_steps;
      FitResult run = c.fitter.fit(from.model, from.motion, options);
      if (is_better(run, anew[at].fit)) anew[at].fit = std::move(run);
    }
  });
  for (Fitted& f : anew) {
    if (!f.fit.good) continue;
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const Fitted& other) {
      return other.candidate == f.candidate;
    });
    const auto at = static_cast<std::size_t>(same - kept.begin());
    if (same == kept.end()) {
      runs.push_back(f.fit);
      kept.push_back(std::move(f));
    } else if (is_better(f.fit, runs[at])) {
      runs[at] = std::move(f.fit);
    }
  }
}

/// Returns `now` plus the effects and freed readings that only `other` has, with amplitudes scaled
/// by `size`.
Model with_effects_of(const Model& now, const Model& other, double size) {
  Model out = now;
  for (std::size_t e = now.effects.size(); e < other.effects.size(); ++e) {
    out.effects.push_back(other.effects[e]);
    scale_amplitude(size, out.effects.back());
  }
  for (const int axis : other.free_gain) out.gain[axis] = other.gain[axis];
  for (const int axis : other.free_clock) out.clock_s[axis] = other.clock_s[axis];
  out.free_gain = other.free_gain;
  out.free_clock = other.free_clock;
  return out;
}

double least_cost(const TrialContext& c, const std::vector<FitResult>& runs) {
  double out = c.now.cost;
  for (const FitResult& r : runs)
    if (r.good) out = std::min(out, r.cost);
  return out;
}

/// Fits the candidates again from the present model, with their full effects or small ones. Earlier
/// laws were fitted to free runs; driven by measured, noisy motion they mislead the fit of the
/// building.
void refit_from_present(const TrialContext& c, const std::vector<Fitted>& kept,
                        std::vector<FitResult>& runs) {
  if (!has_element_law(c.now.model)) return;
  const double least = least_cost(c, runs);
  if (least < c.settings().near_noise * c.fitter.expected(c.now.model)) return;
  run_all(c.parallel, static_cast<int>(kept.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    FitOptions options = full_fit(c.settings(), kept[at].fit.model);
    options.max_steps = 0;
    FitResult from;
    for (const double size : {1.0, c.settings().small_start}) {
      FitResult one = c.fitter.fit(with_effects_of(c.now.model, kept[at].fit.model, size),
                                   c.now.motion, options);
      if (is_better(one, from)) from = std::move(one);
    }
    if (!from.good || from.cost > c.settings().hopeless * least) return;
    FitResult run = c.fitter.fit(from.model, from.motion, full_fit(c.settings(), from.model));
    if (is_better(run, runs[at])) runs[at] = std::move(run);
  });
}

/// Returns the candidates as trials, with their free runs.
std::vector<Trial> trials_of_runs(const TrialContext& c, const std::vector<Fitted>& kept,
                                  const std::vector<FitResult>& runs) {
  std::vector<Trial> out;
  for (std::size_t at = 0; at < kept.size(); ++at) {
    const Fitted& f = kept[at];
    const bool good = runs[at].good;
    out.push_back(trial_of(c, *f.candidate, good ? runs[at] : f.fit,
                           good ? TrialOutcome::fitted : TrialOutcome::diverged));
    if (good && !may_be_named(c, out.back())) out.back().outcome = TrialOutcome::other_law;
  }
  return out;
}

/// Returns "bouc_wen at frame y1, story 2": the candidate with the least cost.
std::string best_of(const TrialContext& c, const std::vector<Fitted>& kept,
                    const std::vector<FitResult>& runs) {
  const FitResult* best = nullptr;
  std::string out;
  for (std::size_t at = 0; at < kept.size(); ++at) {
    if (!runs[at].good || (best != nullptr && best->cost <= runs[at].cost)) continue;
    best = &runs[at];
    const Candidate& candidate = *kept[at].candidate;
    const Plant& plant = c.fitter.plant();
    out = std::string(name_of(candidate.kind)) + " at " +
          place_text(candidate.place, plant.structure, plant.axes);
  }
  return out;
}

/// Fits the free runs of `kept` in parallel. May add runs of friction to both lists.
void fit_runs(const TrialContext& c, const std::vector<Candidate>& candidates,
              std::vector<Fitted>& kept, std::vector<FitResult>& runs) {
  run_all(c.parallel, static_cast<int>(kept.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const FitResult from = free_run_start(c.fitter, kept[at].fit);
    FitOptions options = full_fit(c.settings(), from.model);
    options.max_steps = c.settings().first_steps;
    options.holds_tolerated = c.fitter.plant().is_large();
    runs[at] = c.fitter.fit(from.model, from.motion, options);
  });
  if (const std::string best = best_of(c, kept, runs); !best.empty())
    c.progress(std::to_string(kept.size()) + " laws, so far the best: " + best);
  if (!c.fitter.plant().is_large() && least_cost(c, runs) > c.settings().leaves_little * c.now.cost)
    refit_friction(c, candidates, kept, runs);
  const double least = least_cost(c, runs);
  run_all(c.parallel, static_cast<int>(kept.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    if (!runs[at].good || runs[at].cost > c.settings().hopeless * least ||
        runs[at].steps != c.settings().first_steps)
      return;
    const FitResult on =
        c.fitter.fit(runs[at].model, runs[at].motion, full_fit(c.settings(), runs[at].model));
    if (on.good && on.cost < runs[at].cost) runs[at] = on;
  });
  refit_from_present(c, kept, runs);
}

/// Fits candidates in parallel: all under the measured motion, then the best of each place with
/// free runs.
std::vector<Trial> fit_all(const TrialContext& c, const std::vector<Candidate>& candidates) {
  std::vector<Fitted> first(candidates.size());
  run_all(c.parallel, static_cast<int>(candidates.size()), [&](int i) {
    const Candidate& candidate = candidates[static_cast<std::size_t>(i)];
    FitOptions options;
    options.max_steps = c.settings().rough_steps;
    options.holds_tolerated = c.fitter.plant().is_large();
    first[static_cast<std::size_t>(i)] = {c.fitter.fit(candidate.model, candidate.motion, options),
                                          &candidate};
  });
  std::erase_if(first, [](const Fitted& f) { return !f.fit.good; });
  std::vector<Trial> trials;
  std::vector<Fitted> kept = worth_a_free_run(c, std::move(first), trials);
  std::vector<FitResult> runs(kept.size());
  const auto keep = [&] {
    std::vector<Trial> tried = trials_of_runs(c, kept, runs);
    if (c.fitted != nullptr) append(*c.fitted, tried);
    return tried;
  };
  try {
    fit_runs(c, candidates, kept, runs);
  } catch (...) {  // the search is over
    (void)keep();
    throw;
  }
  append(trials, keep());
  return trials;
}

void unite(std::vector<int>& list, const std::vector<int>& more) {
  for (const int i : more)
    if (std::find(list.begin(), list.end(), i) == list.end()) list.push_back(i);
}

/// Returns two proposals of one pair as one candidate.
Candidate joined(const Localisation& pair, const Proposal& p, const Proposal& q) {
  const std::size_t common = pair.model.effects.size();
  Model model = p.model;
  model.effects.insert(model.effects.end(), q.model.effects.begin() + static_cast<long>(common),
                       q.model.effects.end());
  model.theta += q.model.theta - pair.model.theta;
  model.gain += q.model.gain - pair.model.gain;
  model.clock_s += q.model.clock_s - pair.model.clock_s;
  unite(model.free_gain, q.model.free_gain);
  unite(model.free_clock, q.model.free_clock);
  return {model, pair.motion, p.kind, p.place, std::pair(q.kind, q.place), 0};
}

void add_joined(const Localisation& pair, const std::vector<Proposal>& first,
                const std::vector<Proposal>& second, std::vector<Candidate>& out) {
  for (const Proposal& p : first)
    for (const Proposal& q : second) out.push_back(joined(pair, p, q));
}

}  // namespace

std::vector<Trial> try_places(const TrialContext& c, const std::vector<Localisation>& places,
                              const std::function<bool(EffectKind)>& wanted) {
  std::vector<std::vector<Proposal>> proposals(places.size());
  c.progress("laws at " + std::to_string(places.size()) + " places");
  run_all(c.parallel, static_cast<int>(places.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    proposals[at] = propose(c.fitter, places[at], 0);
  });
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool axis = places[i].candidate_places.front().kind == CandidatePlace::Kind::axis;
    std::size_t count = 0;
    bool friction = false;
    for (const Proposal& p : proposals[i]) {
      if (wanted && !wanted(p.kind)) continue;
      // A family of laws with several names is judged by the name of its fit.
      if (is_excluded(c, p.kind) && p.kind != EffectKind::cubic_stiffness &&
          p.kind != EffectKind::bilinear_hysteresis && p.kind != EffectKind::bouc_wen)
        continue;
      // A poor fit of sticking friction under measured motion is not a reason to skip it.
      const bool first_friction = !friction && ends_with_friction(p.model);
      friction |= first_friction;
      if (!axis && count++ >= c.settings().laws && !first_friction) continue;
      candidates.push_back({p.model, places[i].motion, p.kind, p.place, {}, i});
    }
  }
  c.progress(std::to_string(candidates.size()) + " laws");
  return fit_all(c, candidates);
}

std::vector<Trial> try_effects(const TrialContext& c, const std::vector<Proposal>& proposals) {
  std::vector<Candidate> candidates;
  for (const Proposal& p : proposals)
    candidates.push_back({p.model, c.now.motion, p.kind, p.place, {}, candidates.size()});
  return fit_all(c, candidates);
}

std::vector<Trial> try_pair(const TrialContext& c, const Localisation& pair) {
  const CandidatePlace &a = pair.candidate_places[0], &b = pair.candidate_places[1];
  std::vector<Candidate> candidates;
  if (a.kind == CandidatePlace::Kind::axis && b.kind == CandidatePlace::Kind::axis) {
    ModelEffect swap;
    swap.form = LawForm::swapped;
    swap.place.kind = PlaceKind::channel_pair;
    swap.place.channel = std::min(a.axis, b.axis);
    swap.place.with_channel = std::max(a.axis, b.axis);
    Candidate one{pair.model, {}, EffectKind::swapped, swap.place, {}, 1};
    one.model.effects.push_back(swap);
    candidates.push_back(one);
  }
  const std::size_t most = c.settings().laws_of_pair;
  std::vector<Proposal> first = propose(c.fitter, pair, 0), second = propose(c.fitter, pair, 1);
  for (std::vector<Proposal>* list : {&first, &second}) {
    std::erase_if(*list, [&](const Proposal& p) {
      return p.kind == EffectKind::clipping || p.kind == EffectKind::misalignment ||
             (p.model.effects.size() > pair.model.effects.size() &&
              p.model.effects.back().form == LawForm::broadband) ||
             is_excluded(c, p.kind);
    });
    if (list->size() > most) list->resize(most);
  }
  add_joined(pair, first, second, candidates);
  // One of the two may suffice alone even if its place was not found alone.
  std::size_t from = 0;
  for (const std::vector<Proposal>* list : {&first, &second}) {
    ++from;
    for (const Proposal& p : *list)
      candidates.push_back({p.model, pair.motion, p.kind, p.place, {}, from});
  }
  return fit_all(c, candidates);
}

std::vector<Trial> try_together(const TrialContext& c, const Localisation& place,
                                const std::vector<Proposal>& first,
                                const std::vector<Proposal>& second) {
  std::vector<Candidate> candidates;
  add_joined(place, first, second, candidates);
  return fit_all(c, candidates);
}

}  // namespace framewatch::estimator
