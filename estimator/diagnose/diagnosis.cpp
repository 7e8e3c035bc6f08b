#include "estimator/diagnose/diagnosis.h"

#include <algorithm>
#include <cmath>

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXd;

constexpr double kAdequate = 1.25;  ///< misfit over noise
constexpr double kTakesAway = 0.9;  ///< of the misfit beyond noise, else a law is not named
constexpr double kTakesAll = 0.97;
constexpr double kNearFloor = 2.5;  ///< NRMSE over its floor
constexpr double kAtFloor = 1.15;
constexpr double kSame = 8;  ///< difference of misfits that decides nothing
constexpr double kLeastGain = 50;
constexpr double kSignificant = 4;  ///< standard deviations of the misfit under noise
constexpr double kOnePlace = 1.6;   ///< ratio above which one place does not do
constexpr double kPairShare = 0.4;  ///< of the excess that two places must leave at most
constexpr std::size_t kPairLeaders = 6, kPairs = 3;
constexpr std::size_t kPlaces = 5, kContenders = 3, kLawsFitted = 5, kLawsRun = 3;

double sum(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values) out += v;
  return out;
}

/// Whether an effect is an axis' freed gain or clock rather than a member of the model's effects.
bool is_channel_axis(EffectKind kind) {
  return kind == EffectKind::gain_error || kind == EffectKind::polarity ||
         kind == EffectKind::time_shift || kind == EffectKind::clipping;
}

class Search {
 public:
  Search(const Plant& plant, const std::vector<Stretch>& stretches, const DiagnosisOptions& options)
      : plant_(plant),
        stretches_(stretches),
        options_(options),
        fitter_(plant, stretches, options.tolerances) {
    for (std::size_t r = 0; r < stretches.size(); ++r) expected_ += fitter_.expected(r);
  }

  Diagnosis run() {
    tell("linear model", 0.02);
    FitResult now = fitter_.fit(initial_model(plant_), {}, {});
    if (!now.good) {
      out_.reason = "the linear model cannot be fitted";
      return out_;
    }
    for (std::size_t r = 0; r < stretches_.size(); ++r) {
      // A stretch that fits alone starts the whole better than all of them together.
      const std::vector<Stretch> one{stretches_[r]};
      const Fitter alone(plant_, one, options_.tolerances);
      if (sum(now.misfit) < kAdequate * expected_ || stretches_.size() < 2) break;
      const FitResult fit = alone.fit(initial_model(plant_), {}, {});
      if (!fit.good || sum(fit.misfit) > 1.5 * alone.expected(0)) continue;
      single_ = fit.model;
    }
    out_.linear = now.model;
    out_.before = gaps(now.model);
    out_.ratio_before = sum(now.misfit) / expected_;
    double cost = now.cost;
    bool stuck = false;
    for (int round = 0; round < options_.rounds && !stuck; ++round)
      stuck = !one_round(now, cost, round);
    out_.model = now.model;
    out_.after = gaps(now.model);
    for (const MatrixXcd& m : now.motion) (void)m;
    judge(now);
    return out_;
  }

 private:
  void tell(const std::string& what, double share) const {
    if (options_.progress) options_.progress(what, share);
  }

  std::vector<Gap> gaps(const Model& model) const {
    std::vector<Gap> out;
    for (std::size_t r = 0; r < stretches_.size(); ++r) {
      const Whitened system =
          whiten(plant_, model, stretches_[r], r, Forcing::simulated, {}, fitter_.ratio(r));
      if (system.good) out.push_back(gap_of(plant_, stretches_[r], system));
    }
    return out;
  }

  double holdout(const std::vector<Gap>& gaps) const {
    double error = 0;
    int count = 0;
    for (std::size_t r = 0; r < gaps.size(); ++r)
      if (r >= options_.holdout_from) {
        error += gaps[r].overall;
        ++count;
      }
    return count > 0 ? error / count : 0;
  }

  /// Sharpens the localisation: the places that one step found, refitted.
  std::vector<Localisation> locate(const FitResult& now) {
    const Linearised at = fitter_.linearise(now.model, now.motion, Forcing::measured);
    if (at.systems.size() != stretches_.size() || !at.systems.back().good) return {};
    std::vector<std::vector<Suspect>> lists;
    for (const Suspect& s : suspects_of(plant_, now.model)) lists.push_back({s});
    std::vector<Localisation> once = localise_once(fitter_, at, now.model, lists);
    const auto order = [](const Localisation& a, const Localisation& b) {
      return a.ratio < b.ratio;
    };
    std::stable_sort(once.begin(), once.end(), order);
    std::vector<Localisation> out;
    for (std::size_t i = 0; i < std::min(kPlaces, once.size()); ++i) {
      const Model& start = once[i].model.theta.size() > 0 ? once[i].model : now.model;
      out.push_back(localise(fitter_, start, {}, once[i].suspects, 8));
      if (out.back().model.theta.size() == 0) out.pop_back();
    }
    std::stable_sort(out.begin(), out.end(), order);
    for (std::size_t i = kPlaces; i < std::min<std::size_t>(12, once.size()); ++i)
      rest_.push_back(once[i]);
    once_ = std::move(once);
    return out;
  }

  /// Two places at once: the best single ones with every other, and every two axes.
  std::vector<Localisation> locate_pairs(const FitResult& now) {
    const Linearised at = fitter_.linearise(now.model, now.motion, Forcing::measured);
    if (at.systems.size() != stretches_.size() || !at.systems.back().good) return {};
    std::vector<Suspect> all;
    for (const Localisation& l : once_)
      if (l.suspects.front().size() == 1) all.push_back(l.suspects.front());
    std::vector<std::vector<Suspect>> lists;
    for (std::size_t i = 0; i < std::min(kPairLeaders, all.size()); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) lists.push_back({all[i], all[j]});
    for (std::size_t i = kPairLeaders; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j)
        if (all[i].kind == Suspect::Kind::axis && all[j].kind == Suspect::Kind::axis)
          lists.push_back({all[i], all[j]});
    std::vector<Localisation> once = localise_once(fitter_, at, now.model, lists);
    const auto order = [](const Localisation& a, const Localisation& b) {
      return a.ratio < b.ratio;
    };
    std::stable_sort(once.begin(), once.end(), order);
    std::vector<Localisation> out;
    for (std::size_t i = 0; i < std::min(kPairs, once.size()); ++i) {
      out.push_back(localise(fitter_, once[i].model.theta.size() > 0 ? once[i].model : now.model,
                             {}, once[i].suspects, 6));
      if (out.back().model.theta.size() == 0) out.pop_back();
    }
    std::stable_sort(out.begin(), out.end(), order);
    return out;
  }

  void finish(const FitResult& now, const FitResult& measured, bool law, Trial t,
              std::vector<Trial>& trials) {
    FitOptions options;
    options.max_steps = law || !now.model.effects.empty() ? 8 : 15;
    options.forcing = law || !now.model.effects.empty() ? Forcing::simulated : Forcing::measured;
    const FitResult run = fitter_.fit(measured.model, measured.motion, options);
    if (!run.good) return;
    t.cost = run.cost;
    t.misfit = run.misfit;
    t.model = run.model;
    trials.push_back(std::move(t));
  }

  void try_pair(const FitResult& now, const Localisation& pair, std::vector<Trial>& trials) {
    const Suspect &a = pair.suspects[0], &b = pair.suspects[1];
    if (a.kind == Suspect::Kind::axis && b.kind == Suspect::Kind::axis) {
      ModelEffect swap;
      swap.form = LawForm::swapped;
      swap.place.kind = PlaceKind::channel_pair;
      swap.place.channel = std::min(a.axis, b.axis);
      swap.place.with_channel = std::max(a.axis, b.axis);
      Model model = pair.model;
      model.effects.push_back(swap);
      Trial t;
      t.kind = EffectKind::swapped;
      t.place = swap.place;
      const FitResult fit = fitter_.fit(model, {}, {});
      if (fit.good) finish(now, fit, false, t, trials);
    }
    std::vector<Proposal> first = propose(fitter_, pair, 0), second = propose(fitter_, pair, 1);
    const auto cut = [](std::vector<Proposal>& list, const Suspect& s) {
      std::erase_if(list, [](const Proposal& p) {
        return p.ignores_axis || p.kind == EffectKind::misalignment;
      });
      const std::size_t most = s.kind == Suspect::Kind::axis ? 2 : 2;
      if (list.size() > most) list.resize(most);
    };
    cut(first, a);
    cut(second, b);
    for (const Proposal& p : first)
      for (const Proposal& q : second) {
        Model model = p.model;
        const std::size_t common = pair.model.effects.size();
        model.effects.insert(model.effects.end(),
                             q.model.effects.begin() + static_cast<long>(common),
                             q.model.effects.end());
        model.theta += q.model.theta - pair.model.theta;
        model.gain += q.model.gain - pair.model.gain;
        model.clock_s += q.model.clock_s - pair.model.clock_s;
        for (const int axis : q.model.free_gain)
          if (std::find(model.free_gain.begin(), model.free_gain.end(), axis) ==
              model.free_gain.end())
            model.free_gain.push_back(axis);
        for (const int axis : q.model.free_clock)
          if (std::find(model.free_clock.begin(), model.free_clock.end(), axis) ==
              model.free_clock.end())
            model.free_clock.push_back(axis);
        FitOptions options;
        options.max_steps = 6;
        const FitResult fit = fitter_.fit(model, pair.motion, options);
        if (!fit.good) continue;
        bool law = false;
        for (const ModelEffect& e : model.effects) law = law || e.element_law();
        Trial t;
        std::size_t index = common;
        t.kind = p.model.effects.size() > common
                     ? name_of_fit(fit.model.effects[index++], stretches_.front())
                     : p.kind;
        t.place = p.place;
        t.second = {q.model.effects.size() > common
                        ? name_of_fit(fit.model.effects[index], stretches_.front())
                        : q.kind,
                    q.place};
        finish(now, fit, law, t, trials);
      }
  }

  bool one_round(FitResult& now, double& cost, int round) {
    const double begin = 0.1 + 0.3 * round;
    tell("where", begin);
    std::vector<Localisation> places = locate(now);
    if (places.empty()) return false;
    const double noise = std::min(places.front().ratio, 1.0);
    const double excess = sum(now.misfit) - std::max(noise, 0.5) * expected_;
    record_where(places);
    const double needed = std::max(kLeastGain, kSignificant * std::sqrt(expected_));
    if (excess < needed) return false;

    std::vector<Trial> trials;
    double located = places.front().misfit;
    double unseen = 1;  ///< directions that the bound does not look at
    if (places.front().ratio > kOnePlace) {
      tell("two places", begin + 0.02);
      const std::vector<Localisation> pairs = locate_pairs(now);
      if (!pairs.empty() && pairs.front().ratio - 1 < kPairShare * (places.front().ratio - 1)) {
        located = pairs.front().misfit;
        unseen = 2;
        std::size_t tried = 0;
        for (const Localisation& pair : pairs) {
          if (tried++ >= 2 || pair.ratio > 2 * pairs.front().ratio) break;
          try_pair(now, pair, trials);
        }
      }
    }
    std::size_t contenders = 0;
    for (const Localisation& place : places) {
      if (contenders++ >= kContenders) break;
      if (place.ratio - 1 > 2 * std::max(places.front().ratio - 1, 0.05) + 0.1) break;
      try_place(now, place, trials, begin + 0.05 * static_cast<double>(contenders));
    }
    if (trials.empty()) return false;
    // Two effects must beat one by more than chance.
    const auto price = [&](const Trial& t) { return t.cost + (t.second ? needed : 0.0); };
    std::stable_sort(trials.begin(), trials.end(),
                     [&](const Trial& a, const Trial& b) { return price(a) < price(b); });
    const auto equations = static_cast<double>(plant_.equations());
    const double bound = std::min(located * equations / std::max(equations - unseen, 1.0), cost);
    for (Trial& t : trials) t.fraction = (cost - t.cost) / std::max(cost - bound, 1e-9);
    const Trial& best = trials.front();
    bool holds = best.fraction >= kTakesAway && cost - best.cost > needed;
    for (std::size_t r = 0; r < stretches_.size(); ++r)
      if (best.misfit[r] > 1.02 * now.misfit[r] + needed) holds = false;
    if (!holds) {
      out_.rejected = trials;
      return false;
    }
    FoundEffect found;
    found.before = holdout(gaps(now.model));
    found.chosen = best;
    found.after = holdout(gaps(best.model));
    found.index = best.model.effects.size() > now.model.effects.size()
                      ? static_cast<int>(best.model.effects.size()) - 1
                      : -1;
    for (std::size_t i = 1; i < trials.size(); ++i) {
      found.alternatives.push_back(trials[i]);
      if (trials[i].cost < best.cost + kSame && trials[i].kind != best.kind)
        found.like.push_back(trials[i].kind);
    }
    const std::size_t old_effects = now.model.effects.size();
    const double margin = trials.size() > 1 ? trials[1].cost - best.cost : 1e3;
    found.confidence = found.like.empty() ? std::min(0.999, 1 - 0.5 * std::exp(-margin / 20)) : 0.5;
    FitResult next;
    next.good = true;
    next.model = best.model;
    next.misfit = best.misfit;
    next.cost = best.cost;
    next.motion = now.motion;
    std::vector<MatrixXcd> motion(stretches_.size());
    fitter_.misfit(next.model, motion, Forcing::simulated);
    next.motion = motion;
    const std::optional<std::pair<EffectKind, EffectPlace>> second = best.second;
    if (second && found.index >= 0) found.index = static_cast<int>(old_effects);
    FoundEffect other = found;
    const std::size_t added = next.model.effects.size() - old_effects;
    if (second) {
      const bool first_in_model = !is_channel_axis(best.kind);
      if (!first_in_model) found.index = -1;
      other.chosen.kind = second->first;
      other.chosen.place = second->second;
      other.index =
          is_channel_axis(second->first) ? -1 : static_cast<int>(old_effects + (added > 1 ? 1 : 0));
    }
    out_.effects.push_back(std::move(found));
    if (second) out_.effects.push_back(std::move(other));
    now = std::move(next);
    cost = now.cost;
    return sum(now.misfit) > kAdequate * expected_;
  }

  void try_place(const FitResult& now, const Localisation& place, std::vector<Trial>& trials,
                 double share) {
    std::vector<Proposal> proposals = propose(fitter_, place, 0);
    const bool axis = place.suspects.front().kind == Suspect::Kind::axis;
    if (!axis && proposals.size() > kLawsFitted) proposals.resize(kLawsFitted);
    struct Fitted {
      FitResult fit;
      const Proposal* from;
    };
    std::vector<Fitted> fitted;
    std::size_t done = 0;
    for (const Proposal& p : proposals) {
      tell(std::string(name_of(p.kind)) + " at " +
               place_text(p.place, plant_.structure, plant_.axes),
           share + 0.04 * static_cast<double>(done++) / static_cast<double>(proposals.size()));
      if (p.ignores_axis) continue;
      FitOptions options;
      options.max_steps = 5;
      fitted.push_back({fitter_.fit(p.model, place.motion, options), &p});
      if (!fitted.back().fit.good) fitted.pop_back();
    }
    std::stable_sort(fitted.begin(), fitted.end(),
                     [](const Fitted& a, const Fitted& b) { return a.fit.cost < b.fit.cost; });
    if (fitted.size() > kLawsRun) fitted.resize(kLawsRun);
    for (const Fitted& f : fitted) {
      const bool law = !f.fit.model.effects.empty() && f.fit.model.effects.back().element_law() &&
                       f.fit.model.effects.size() > now.model.effects.size();
      FitResult run = f.fit;
      if (!law && now.model.effects.empty()) {
        FitOptions options;
        options.max_steps = 15;
        run = fitter_.fit(f.fit.model, f.fit.motion, options);
        if (!run.good) continue;
      }
      if (law || now.model.effects.size() > 0) {
        FitOptions options;
        options.forcing = Forcing::simulated;
        options.max_steps = 8;
        run = fitter_.fit(f.fit.model, f.fit.motion, options);
        if (!run.good) continue;
      }
      Trial t;
      t.place = f.from->place;
      t.kind = run.model.effects.size() > now.model.effects.size()
                   ? name_of_fit(run.model.effects.back(), stretches_.front())
                   : f.from->kind;
      t.cost = run.cost;
      t.misfit = run.misfit;
      t.model = run.model;
      trials.push_back(std::move(t));
    }
    for (const Proposal& p : proposals) {
      if (!p.ignores_axis) continue;
      Trial t;
      t.place = p.place;
      t.kind = p.kind;
      const double share_left =
          static_cast<double>(plant_.equations()) / static_cast<double>(plant_.equations() - 1);
      t.cost = place.misfit * share_left;
      for (std::size_t r = 0; r < stretches_.size(); ++r)
        t.misfit.push_back(place.record_ratio[r] * fitter_.expected(r));
      t.model = place.model;
      trials.push_back(std::move(t));
    }
  }

  void record_where(const std::vector<Localisation>& places) {
    if (!out_.where.empty()) return;
    for (const Localisation& p : places) {
      WhereEntry entry;
      entry.place = p.suspects.front().place;
      entry.ratio = p.ratio;
      out_.where.push_back(entry);
    }
  }

  void judge(const FitResult& now) {
    out_.ratio_after = sum(now.misfit) / expected_;
    const bool none = out_.effects.empty();
    double worst_ratio = 0, gap = 0, floor = 0;
    for (const Gap& g : out_.after) {
      worst_ratio = std::max(worst_ratio, g.overall / std::max(g.overall_floor, 1e-12));
      gap += g.overall;
      floor += g.overall_floor;
    }
    const bool fits = out_.ratio_after < kAdequate || worst_ratio < kAtFloor;
    if (none) {
      out_.verdict = fits ? Verdict::adequate : Verdict::unexplained;
      return;
    }
    const double fraction =
        (out_.ratio_before - out_.ratio_after) / std::max(out_.ratio_before - 1, 1e-9);
    out_.verdict = fits || (fraction > kTakesAll && gap < kNearFloor * floor)
                       ? Verdict::explained
                       : Verdict::partly_explained;
  }

  const Plant& plant_;
  const std::vector<Stretch>& stretches_;
  const DiagnosisOptions& options_;
  Fitter fitter_;
  double expected_ = 0;
  Model single_;
  std::vector<Localisation> rest_, once_;
  Diagnosis out_;
};

}  // namespace

const char* verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::adequate:
      return "adequate";
    case Verdict::explained:
      return "explained";
    case Verdict::partly_explained:
      return "partly_explained";
    case Verdict::unexplained:
      break;
  }
  return "unexplained";
}

Diagnosis diagnose(const Plant& plant, const std::vector<Stretch>& stretches,
                   const DiagnosisOptions& options) {
  return Search(plant, stretches, options).run();
}

}  // namespace framewatch
