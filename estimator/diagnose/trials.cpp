#include "estimator/diagnose/trials.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "estimator/diagnose/begin_run.h"
#include "estimator/diagnose/onset.h"
#include "estimator/diagnose/trial_names.h"

namespace framewatch {
namespace {

constexpr std::size_t kLawsFitted = 6, kLawsRun = 3, kPairLaws = 2;
constexpr double kRoundest = 20;  ///< exponent of hysteresis; above it has a corner
constexpr int kSharpSteps = 12;
constexpr int kGlance = 3;      ///< steps of a free run's fit after which it is seen what leads
constexpr double kStillIn = 4;  ///< times the least cost: what is worse then is not fitted on
constexpr int kFirstSteps = 5, kPairSteps = 6, kRunSteps = 8, kLinearSteps = 15;

/// A model with what it is called.
struct Candidate {
  Model model;
  std::vector<Eigen::MatrixXcd> motion;
  EffectKind kind;
  EffectPlace place;
  std::optional<std::pair<EffectKind, EffectPlace>> second;
  std::size_t from = 0;  ///< place it is of
  int steps = kFirstSteps;
};

struct Fitted {
  FitResult fit;
  const Candidate* candidate;
};

FitOptions to_the_end(const Model& model) {
  FitOptions options;
  options.forcing = forcing_of(model);
  options.max_steps = options.forcing == Forcing::simulated ? kRunSteps : kLinearSteps;
  return options;
}

Trial trial_of(const TrialContext& c, const Candidate& candidate, const FitResult& fit, Fate fate) {
  Trial out;
  out.fate = fate;
  out.kind = candidate.kind;
  out.place = candidate.place;
  out.second = candidate.second;
  take(c, fit, out);
  return out;
}

/// The best of each place, and as many of those whose names could be given; the others are outrun.
std::vector<Fitted> worth_running(const TrialContext& c, std::vector<Fitted> first,
                                  std::vector<Trial>& outrun) {
  std::stable_sort(first.begin(), first.end(), [](const Fitted& a, const Fitted& b) {
    return a.candidate->from != b.candidate->from ? a.candidate->from < b.candidate->from
                                                  : a.fit.cost < b.fit.cost;
  });
  std::vector<Fitted> out;
  std::size_t place = 0, of_place = 0, named_of_place = 0;
  for (Fitted& f : first) {
    if (f.candidate->from != place) of_place = named_of_place = 0;
    place = f.candidate->from;
    Trial driven = trial_of(c, *f.candidate, f.fit, Fate::outrun);
    const bool named = is_named(c, driven);
    if (!f.candidate->second && of_place >= kLawsRun && (!named || named_of_place >= kLawsRun)) {
      outrun.push_back(std::move(driven));
      continue;
    }
    ++of_place;
    named_of_place += named;
    out.push_back(std::move(f));
  }
  return out;
}

/// Fits all at once: first with the measured motion, the best of each place then as free runs.
std::vector<Trial> fit_all(const TrialContext& c, const std::vector<Candidate>& candidates) {
  std::vector<Fitted> first(candidates.size());
  run_all(c.parallel, static_cast<int>(candidates.size()), [&](int i) {
    const Candidate& candidate = candidates[static_cast<std::size_t>(i)];
    FitOptions options;
    options.max_steps = candidate.steps;
    first[static_cast<std::size_t>(i)] = {c.fitter.fit(candidate.model, candidate.motion, options),
                                          &candidate};
  });
  std::erase_if(first, [](const Fitted& f) { return !f.fit.good; });
  std::vector<Trial> trials;
  std::vector<Fitted> kept = worth_running(c, std::move(first), trials);
  std::vector<FitResult> runs(kept.size());
  std::vector<Trial> out;
  for (const Fitted& f : kept) out.push_back(trial_of(c, *f.candidate, f.fit, Fate::ran_away));
  run_all(c.parallel, static_cast<int>(kept.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const FitResult from = begin_run(c.fitter, std::move(kept[at].fit));
    FitOptions options = to_the_end(from.model);
    options.max_steps = kGlance;
    runs[at] = c.fitter.fit(from.model, from.motion, options);
  });
  double least = 1e300;
  for (const FitResult& r : runs)
    if (r.good) least = std::min(least, r.cost);
  run_all(c.parallel, static_cast<int>(kept.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    if (!runs[at].good) return;
    if (runs[at].cost < kStillIn * least && runs[at].steps == kGlance) {
      const FitResult on =
          c.fitter.fit(runs[at].model, runs[at].motion, to_the_end(runs[at].model));
      if (on.good && on.cost < runs[at].cost) runs[at] = on;
    }
    Trial& t = out[at] = trial_of(c, *kept[at].candidate, runs[at], Fate::fitted);
    if (!is_named(c, t)) t.fate = Fate::other_law;
  });
  append(trials, std::move(out));
  return trials;
}

void unite(std::vector<int>& list, const std::vector<int>& more) {
  for (const int i : more)
    if (std::find(list.begin(), list.end(), i) == list.end()) list.push_back(i);
}

/// Two proposals of one pair together.
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
  return {model, pair.motion, p.kind, p.place, std::pair(q.kind, q.place), 0, kPairSteps};
}

}  // namespace

void append(std::vector<Trial>& list, std::vector<Trial> more) {
  list.insert(list.end(), std::make_move_iterator(more.begin()),
              std::make_move_iterator(more.end()));
}

void free_shapes(Model& model) {
  for (ModelEffect& e : model.effects) {
    const bool hysteretic = e.form == LawForm::hysteresis || e.form == LawForm::pinched;
    if (!hysteretic || e.knobs[2].plain() > kRoundest) continue;
    e.knobs[2].free = e.knobs[3].free = true;
    e.knobs[2].low = 1;
    e.knobs[3].low = 0.5;
  }
}

Model fitted_to_the_weakest(const TrialContext& c, const Model& model) {
  const bool of_records = std::any_of(model.effects.begin(), model.effects.end(),
                                      [](const ModelEffect& e) { return !e.record_knobs.empty(); });
  const std::vector<Stretch>& all = c.fitter.stretches();
  if (all.size() < 2 || of_records) return model;
  const auto strength = [&](std::size_t r) {
    return c.now.misfit[r] / c.fitter.expected(r, c.now.model);
  };
  std::size_t weakest = 0;
  for (std::size_t r = 1; r < all.size(); ++r)
    if (strength(r) < strength(weakest)) weakest = r;
  const std::vector<Stretch> one{all[weakest]};
  const Fitter alone(c.fitter.plant(), one, c.fitter.tolerances());
  const FitResult run = alone.fit(model, {}, thorough(model, kSharpSteps));
  return run.good ? run.model : model;
}

Trial sharpened(const TrialContext& c, const Trial& trial, const Model& from) {
  Model start = from;
  free_shapes(start);
  FitResult run = c.fitter.fit(start, {}, thorough(start, kSharpSteps));
  if (!run.good) return trial;
  if (ends_with_harmonic(run.model)) run = with_onsets(c.fitter, std::move(run));
  Trial out = trial;
  take(c, run, out);
  return out.cost < trial.cost && is_named(c, out) ? out : trial;
}

bool is_axis_error(EffectKind kind) {
  return kind == EffectKind::gain_error || kind == EffectKind::polarity ||
         kind == EffectKind::time_shift;
}

double spared(const Fitter& fitter, const Model& model) {
  double directions = 0, bins = 0;
  for (const ModelEffect& e : model.effects)
    directions += e.form == LawForm::clipped || e.form == LawForm::broadband;
  for (const Stretch& s : fitter.stretches()) bins += static_cast<double>(s.bins());
  return directions * bins;
}

std::vector<Trial> try_places(const TrialContext& c, const std::vector<Localisation>& places) {
  std::vector<std::vector<Proposal>> proposals(places.size());
  c.progress("laws at " + std::to_string(places.size()) + " places", 0);
  run_all(c.parallel, static_cast<int>(places.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    proposals[at] = propose(c.fitter, places[at], 0);
  });
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool axis = places[i].suspects.front().kind == Suspect::Kind::axis;
    std::size_t count = 0;
    for (const Proposal& p : proposals[i]) {
      // A family that has other names too is judged by the name after its fit.
      if (is_taken_out(c, p.kind) && p.kind != EffectKind::cubic_stiffness &&
          p.kind != EffectKind::bilinear_hysteresis && p.kind != EffectKind::bouc_wen)
        continue;
      if (!axis && count++ >= kLawsFitted) break;
      candidates.push_back({p.model, places[i].motion, p.kind, p.place, {}, i, kFirstSteps});
    }
  }
  c.progress(std::to_string(candidates.size()) + " laws", 0.3);
  return fit_all(c, candidates);
}

std::vector<Trial> try_pair(const TrialContext& c, const Localisation& pair) {
  const Suspect &a = pair.suspects[0], &b = pair.suspects[1];
  std::vector<Candidate> candidates;
  if (a.kind == Suspect::Kind::axis && b.kind == Suspect::Kind::axis) {
    ModelEffect swap;
    swap.form = LawForm::swapped;
    swap.place.kind = PlaceKind::channel_pair;
    swap.place.channel = std::min(a.axis, b.axis);
    swap.place.with_channel = std::max(a.axis, b.axis);
    Candidate one{pair.model, {}, EffectKind::swapped, swap.place, {}, 1, 12};
    one.model.effects.push_back(swap);
    candidates.push_back(one);
  }
  std::vector<Proposal> first = propose(c.fitter, pair, 0), second = propose(c.fitter, pair, 1);
  for (std::vector<Proposal>* list : {&first, &second}) {
    std::erase_if(*list, [&](const Proposal& p) {
      return p.kind == EffectKind::clipping || p.kind == EffectKind::misalignment ||
             (p.model.effects.size() > pair.model.effects.size() &&
              p.model.effects.back().form == LawForm::broadband) ||
             is_taken_out(c, p.kind);
    });
    if (list->size() > kPairLaws) list->resize(kPairLaws);
  }
  for (const Proposal& p : first)
    for (const Proposal& q : second) candidates.push_back(joined(pair, p, q));
  // One of the two may do alone, though alone its place was not found.
  std::size_t from = 0;
  for (const std::vector<Proposal>* list : {&first, &second}) {
    ++from;
    for (const Proposal& p : *list)
      candidates.push_back({p.model, pair.motion, p.kind, p.place, {}, from, kPairSteps});
  }
  return fit_all(c, candidates);
}

}  // namespace framewatch
