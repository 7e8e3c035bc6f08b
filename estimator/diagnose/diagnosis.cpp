#include "estimator/diagnose/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/bias.h"
#include "estimator/diagnose/known_effects.h"
#include "estimator/diagnose/locate.h"
#include "estimator/diagnose/parameter_errors.h"
#include "estimator/diagnose/trials.h"
#include "estimator/diagnose/where.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;

constexpr double kAdequate = 1.25;   ///< misfit over noise
constexpr double kAdequateGap = 2;   ///< NRMSE over its floor
constexpr double kTakesAway = 0.97;  ///< of the misfit beyond noise, else a law is not named
constexpr double kTakesMost = 0.9;   ///< the same where the rest is within chance
constexpr double kSharp = 0.995;     ///< share above which a fit need not be sharpened
constexpr double kOneLaw =
    0.99;  ///< share above which a second law at a place is no sign of another
constexpr std::size_t kSharpened = 3;
constexpr double kTakesAll = 0.97;
constexpr double kNearFloor = 2.5;  ///< NRMSE over its floor
constexpr double kAtFloor = 1.15;
constexpr double kSame = 8;  ///< difference of misfits that decides nothing
constexpr double kLeastGain = 50;
constexpr double kSignificant = 4;  ///< standard deviations of the misfit under noise
constexpr double kOnePlace = 1.6;   ///< ratio above which one place does not do
constexpr double kPairShare = 0.4;  ///< of the excess that two places must leave at most
/// Of the excess: what an arbitrary force must be better by than a law.
constexpr double kOwnPrice = 1 - kTakesAway;
constexpr double kApart =
    0.25;  ///< of the excess that records leave at most if each may be another building
constexpr double kUndetermined = 1.5;  ///< gap of a model of the training records over that of all
constexpr int kPolishSteps = 6, kTrainSteps = 8, kDeclaredSteps = 5;

double sum(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values) out += v;
  return out;
}

/// Whether an effect is an axis' freed gain or clock rather than a member of the model's effects.
bool is_axis_error(EffectKind kind) {
  return kind == EffectKind::gain_error || kind == EffectKind::polarity ||
         kind == EffectKind::time_shift;
}

bool has_law(const Model& model) {
  return std::any_of(model.effects.begin(), model.effects.end(),
                     [](const ModelEffect& e) { return e.element_law(); });
}

Forcing forcing_of(const Model& model) {
  return has_law(model) ? Forcing::simulated : Forcing::measured;
}

/// How many values of a model are fitted beyond those of the linear building.
double fitted_values(const Model& model) {
  const auto free = [](const std::vector<Knob>& knobs) {
    return std::count_if(knobs.begin(), knobs.end(), [](const Knob& k) { return k.free; });
  };
  auto out = static_cast<double>(model.free_gain.size() + model.free_clock.size());
  for (const ModelEffect& e : model.effects) {
    out += static_cast<double>(free(e.knobs));
    for (const std::vector<Knob>& knobs : e.record_knobs) out += static_cast<double>(free(knobs));
  }
  return out;
}

std::vector<Gap> gaps_of(const Fitter& fitter, const Model& model) {
  std::vector<Gap> out;
  for (std::size_t r = 0; r < fitter.stretches().size(); ++r) {
    const Stretch& s = fitter.stretches()[r];
    const Whitened system =
        whiten(fitter.plant(), model, s, r, Forcing::simulated, {}, fitter.ratio(r));
    if (system.good) out.push_back(gap_of(fitter.plant(), model, s, system));
  }
  return out;
}

/// Exponents that a name stands for are what it says.
void fix_exponent(EffectKind kind, ModelEffect& effect) {
  const bool power = effect.form == LawForm::power || effect.form == LawForm::power_damping;
  if (!power) return;
  Knob& exponent = effect.knobs[1];
  const double value = kind == EffectKind::cubic_stiffness ? 3 : 2;
  exponent.value = exponent.logarithmic ? std::log(value) : value;
  exponent.free = false;
}

/// A force on the lowest story of a frame is one at its floor.
bool same_spot(const EffectPlace& a, const EffectPlace& b) {
  if (a == b) return true;
  const auto element_or_node = [](const EffectPlace& p) {
    return p.kind == PlaceKind::frame || p.kind == PlaceKind::node;
  };
  const bool alike = a.kind == b.kind || (a.story == 1 && b.story == 1);
  return element_or_node(a) && element_or_node(b) && alike && a.story == b.story &&
         a.frame == b.frame;
}

class Search {
 public:
  Search(const Plant& plant, const std::vector<Stretch>& stretches, const DiagnosisOptions& options)
      : plant_(plant),
        stretches_(stretches),
        options_(options),
        fitter_(plant, stretches, options.tolerances) {}

  Diagnosis run(std::vector<FoundEffect> ramps) {
    tell("linear model", 0.02);
    Model start = initial_model(plant_);
    out_.known = add_known(plant_, stretches_, options_.known, start);
    FitResult now = fit(start, {}, 12);
    if (!now.good) {
      out_.reason = "the model cannot be fitted to these records";
      return out_;
    }
    known_ = now.model.effects.size();
    out_.linear = now.model;
    out_.ratio_before = ratio(now);
    double cost = now.cost;
    bool more = true;
    for (int round = 0; round < options_.rounds && more; ++round)
      more = one_round(now, cost, round);
    tell("what stays", 0.92);
    if (!out_.effects.empty()) polish(now);
    out_.model = now.model;
    out_.declared = declared(now.model);
    out_.ratio_after = ratio(now);
    set_errors(fitter_, now.model, now.motion, out_.effects);
    set_errors(fitter_, now.model, now.motion, out_.known);
    out_.effects.insert(out_.effects.begin(), ramps.begin(), ramps.end());
    honest_gaps();
    judge();
    return out_;
  }

 private:
  void tell(const std::string& what, double share) const {
    if (options_.progress) options_.progress(what, share);
  }

  FitResult fit(const Model& model, const std::vector<MatrixXcd>& motion, int steps) const {
    FitOptions options;
    options.forcing = forcing_of(model);
    options.max_steps = steps;
    return fitter_.fit(model, motion, options);
  }

  double expected(const Model& model) const {
    double out = 0;
    for (std::size_t r = 0; r < stretches_.size(); ++r) out += fitter_.expected(r, model);
    return out;
  }

  double ratio(const FitResult& now) const { return sum(now.misfit) / expected(now.model); }

  /// Mean over the held-out stretches.
  double holdout(const std::vector<Gap>& gaps) const {
    double error = 0;
    int count = 0;
    for (std::size_t r = options_.holdout_from; r < gaps.size(); ++r, ++count)
      error += gaps[r].overall;
    return count > 0 ? error / count : 0;
  }

  /// Everything together once more, with the shape of hysteresis free.
  void polish(FitResult& now) {
    Model start = now.model;
    free_shapes(start);
    const FitResult better = fit(start, now.motion, kPolishSteps);
    if (better.good && better.cost < now.cost) now = better;
  }

  /// Step by step: a stiff law may lose its way when all of the errors go at once.
  Model declared(const Model& fitted) const {
    Model out = fitted;
    for (const auto* list : {&out_.known, &out_.effects})
      for (const FoundEffect& found : *list)
        if (found.index >= 0)
          fix_exponent(found.chosen.kind, out.effects[static_cast<std::size_t>(found.index)]);
    const Model none = initial_model(plant_);
    const auto shrink = [&](Eigen::VectorXd Model::*errors, double share,
                            const std::vector<int>& free) {
      for (Index a = 0; a < (out.*errors).size(); ++a)
        if (std::find(free.begin(), free.end(), static_cast<int>(a)) == free.end())
          (out.*errors)[a] = share * (fitted.*errors)[a] + (1 - share) * (none.*errors)[a];
    };
    const Fitter exact(plant_, stretches_, {0, 0, 0});
    FitOptions options;
    options.forcing = forcing_of(out);
    options.max_steps = kDeclaredSteps;
    for (const double share : {0.75, 0.5, 0.25, 0.0}) {
      shrink(&Model::mass_change, share, {});
      shrink(&Model::gain, share, out.free_gain);
      shrink(&Model::clock_s, share, out.free_clock);
      const FitResult next = exact.fit(out, {}, options);
      if (next.good) out = next.model;
    }
    return out;
  }

  std::vector<Trial> trials_of(const FitResult& now, const Located& located, double begin,
                               double& bound) {
    const auto progress = [&](const std::string& what, double share) {
      tell(what, begin + 0.05 + 0.2 * share);
    };
    const TrialContext context{fitter_, now, options_.without, options_.parallel, progress};
    const Localisation& best = located.places.front();
    const double equations = static_cast<double>(plant_.equations());
    double left = best.misfit, unseen = static_cast<double>(best.suspects.front().size());
    std::vector<Trial> trials;
    if (best.ratio > kOnePlace) {
      tell("two places", begin + 0.02);
      const std::vector<Localisation> pairs =
          locate_pairs(fitter_, now, located.once, options_.parallel);
      if (!pairs.empty() && pairs.front().ratio - 1 < kPairShare * (best.ratio - 1)) {
        left = pairs.front().misfit;
        unseen = 2;
        for (std::size_t i = 0; i < std::min<std::size_t>(2, pairs.size()); ++i) {
          if (pairs[i].ratio > 2 * pairs.front().ratio) break;
          const std::vector<Trial> more = try_pair(context, pairs[i]);
          trials.insert(trials.end(), more.begin(), more.end());
        }
      }
    }
    std::vector<Localisation> places = contenders(located.places);
    const std::vector<Localisation> more = as_likely(fitter_, now, located, options_.parallel);
    places.insert(places.end(), more.begin(), more.end());
    const std::vector<Trial> single = try_places(context, places);
    trials.insert(trials.end(), single.begin(), single.end());
    bound = left * equations / std::max(equations - unseen, 1.0);
    return trials;
  }

  bool one_round(FitResult& now, double& cost, int round) {
    const double begin = 0.06 + 0.28 * round;
    tell("where", begin);
    const Located located = locate(fitter_, now, options_.parallel);
    if (located.places.empty()) return false;
    const double expected_now = expected(now.model);
    const double noise = std::clamp(located.places.front().ratio, 0.5, 1.0);
    const double excess = sum(now.misfit) - noise * expected_now;
    if (out_.where.empty()) {
      out_.where = where_of(fitter_, located.places);
      out_.map = map_of(located);
    }
    const double needed = std::max(kLeastGain, kSignificant * std::sqrt(expected_now));
    if (excess < needed) return false;

    double bound = 0;
    std::vector<Trial> trials = trials_of(now, located, begin, bound);
    if (trials.empty()) return false;
    bound = std::min(bound, cost);
    // Two effects must beat one by more than chance, a law what any force would do, and every
    // value that is fitted what values fit of noise.
    const double of_value = 0.5 * std::log(expected_now);
    const auto price = [&](const Trial& t) {
      const bool any = t.model.effects.size() > now.model.effects.size() &&
                       t.model.effects.back().form == LawForm::broadband;
      return t.cost + of_value * fitted_values(t.model) + (t.second ? needed : 0.0) +
             (any ? needed + kOwnPrice * std::max(cost - bound, 0.0) : 0.0);
    };
    const auto rank = [&] {
      std::stable_sort(trials.begin(), trials.end(),
                       [&](const Trial& a, const Trial& b) { return price(a) < price(b); });
      for (Trial& t : trials) t.fraction = (cost - t.cost) / std::max(cost - bound, 1e-9);
    };
    rank();
    sharpen(trials, now);
    rank();
    const Trial& best = trials.front();
    // In a component test the place is no question, and real parts follow no law to the end.
    const bool component = plant_.equations() == 1;
    const bool most = best.fraction >= (component ? kTakesMost : kTakesAway) ||
                      (best.fraction >= kTakesMost && best.cost - bound < needed);
    bool holds = most && cost - best.cost > needed;
    for (std::size_t r = 0; r < stretches_.size(); ++r)
      if (best.misfit[r] > 1.02 * now.misfit[r] + needed) holds = false;
    if (!holds) {
      out_.rejected = trials;
      return false;
    }
    for (std::size_t i = 0; i < out_.effects.size(); ++i) {
      const FoundEffect& earlier = out_.effects[i];
      if (!same_spot(earlier.chosen.place, best.place)) continue;
      // Two laws at one place are one that the catalogue does not have.
      if (earlier.chosen.fraction < kOneLaw && !component) withdraw(now, i);
      return false;
    }
    adopt(trials, now);
    cost = now.cost;
    return true;
  }

  void sharpen(std::vector<Trial>& trials, const FitResult& now) const {
    const auto progress = [&](const std::string&, double) {};
    const TrialContext context{fitter_, now, options_.without, options_.parallel, progress};
    const auto count = static_cast<int>(std::min(kSharpened, trials.size()));
    run_all(options_.parallel, count, [&](int i) {
      Trial& t = trials[static_cast<std::size_t>(i)];
      if (t.fraction < kSharp && t.fraction > kPairShare) t = sharpened(context, t);
    });
  }

  /// Back to before the effect `first` was added.
  void withdraw(FitResult& now, std::size_t first) {
    out_.reason = "no single law of the catalogue is what acts at " +
                  place_text(out_.effects[first].chosen.place, plant_.structure, plant_.axes);
    out_.rejected.clear();
    for (std::size_t i = first; i < out_.effects.size(); ++i)
      out_.rejected.push_back(out_.effects[i].chosen);
    out_.effects.resize(first);
    now = fit(first == 0 ? out_.linear : out_.effects.back().chosen.model, {}, kTrainSteps);
  }

  void adopt(const std::vector<Trial>& trials, FitResult& now) {
    const Trial& best = trials.front();
    FoundEffect found;
    found.chosen = best;
    found.before = holdout(gaps_of(fitter_, now.model));
    found.after = holdout(gaps_of(fitter_, best.model));
    for (std::size_t i = 1; i < trials.size(); ++i) {
      found.alternatives.push_back(trials[i]);
      if (trials[i].cost < best.cost + kSame && trials[i].kind != best.kind &&
          std::find(found.like.begin(), found.like.end(), trials[i].kind) == found.like.end())
        found.like.push_back(trials[i].kind);
    }
    const double margin = trials.size() > 1 ? trials[1].cost - best.cost : 1e3;
    found.confidence = found.like.empty() ? std::min(0.999, 1 - 0.5 * std::exp(-margin / 20)) : 0.5;
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
    FitResult extended;
    extended.good = true;
    extended.model = best.model;
    extended.misfit = best.misfit;
    extended.motion = now.motion;
    const std::vector<double> own =
        fitter_.misfit(extended.model, extended.motion, Forcing::simulated);
    extended.cost = own.empty() ? best.cost : sum(own);
    now = std::move(extended);
  }

  /// Gaps of models that have not seen the held-out stretches.
  void honest_gaps() {
    const std::vector<Stretch> seen(
        stretches_.begin(),
        stretches_.begin() + static_cast<long>(std::min(options_.holdout_from, stretches_.size())));
    const Fitter train(plant_, seen, options_.tolerances);
    const auto of_train = [&](const Model& start) {
      FitOptions options;
      options.forcing = forcing_of(start);
      options.max_steps = kTrainSteps;
      const FitResult fitted = train.fit(start, {}, options);
      return gaps_of(fitter_, fitted.good ? fitted.model : start);
    };
    out_.before = of_train(out_.linear);
    if (out_.model.effects.size() == known_ && out_.effects.empty()) {
      out_.after = out_.before;
      return;
    }
    out_.after = of_train(out_.model);
    const std::vector<Gap> all = gaps_of(fitter_, out_.model);
    if (holdout(out_.after) > kUndetermined * holdout(all)) {
      out_.after = all;
      out_.after_of_all = true;
    }
  }

  void judge() {
    double worst = 0, gap = 0, floor = 0, before = 0;
    for (const Gap& g : out_.after) {
      worst = std::max(worst, g.overall / std::max(g.overall_floor, 1e-12));
      gap += g.overall;
      floor += g.overall_floor;
    }
    for (const Gap& g : out_.before)
      before = std::max(before, g.overall / std::max(g.overall_floor, 1e-12));
    const bool fits = out_.ratio_after < kAdequate || worst < kAtFloor;
    if (out_.effects.empty()) {
      const bool adequate = fits && (before < kAdequateGap || out_.rejected.empty());
      out_.verdict = adequate ? Verdict::adequate : Verdict::unexplained;
      if (!adequate && out_.reason.empty() && fit_apart())
        out_.reason =
            "each record alone fits a linear building, all of them together do not: they are of "
            "different buildings, or the building changed between them";
      return;
    }
    const double fraction =
        (out_.ratio_before - out_.ratio_after) / std::max(out_.ratio_before - 1, 1e-9);
    out_.verdict = fits || (fraction > kTakesAll && gap < kNearFloor * floor)
                       ? Verdict::explained
                       : Verdict::partly_explained;
  }

  /// Whether most of the misfit is gone when every stretch may be of a building of its own.
  bool fit_apart() const {
    double misfit = 0, noise = 0;
    for (const Stretch& s : stretches_) {
      const std::vector<Stretch> one{s};
      const Fitter alone(plant_, one, options_.tolerances);
      const FitResult fitted = alone.fit(initial_model(plant_), {}, {});
      if (!fitted.good) return false;
      misfit += sum(fitted.misfit);
      noise += alone.expected(0, fitted.model);
    }
    return misfit / noise - 1 < kApart * (out_.ratio_before - 1);
  }

  const Plant& plant_;
  const std::vector<Stretch>& stretches_;
  const DiagnosisOptions& options_;
  Fitter fitter_;
  std::size_t known_ = 0;
  Diagnosis out_;
};

/// Ramps that the configuration knows, and those that are found, taken off the stretches.
std::vector<FoundEffect> take_ramps(const Plant& plant, const DiagnosisOptions& options,
                                    std::vector<Stretch>& stretches) {
  for (const Effect& e : options.known)
    if (e.kind == EffectKind::bias_drift)
      for (Stretch& s : stretches)
        s = without_ramp(s, e.place.channel, {e.value("ramp_mps3"), e.value("from_s"), 0});
  std::vector<FoundEffect> out;
  if (std::find(options.without.begin(), options.without.end(), EffectKind::bias_drift) !=
      options.without.end())
    return out;
  const std::vector<Stretch> whole = stretches;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    FoundEffect found;
    found.chosen.kind = EffectKind::bias_drift;
    found.chosen.place.kind = PlaceKind::channel;
    found.chosen.place.channel = static_cast<int>(a);
    found.chosen.fraction = 1;
    found.confidence = 0.99;
    bool any = false;
    for (std::size_t r = 0; r < stretches.size(); ++r) {
      const auto ramp = find_ramp(plant, whole[r], a);
      found.ramp_mps3.push_back(ramp ? ramp->slope : 0);
      found.ramp_from_s.push_back(ramp ? ramp->from_s : 0);
      if (!ramp) continue;
      any = true;
      stretches[r] = without_ramp(stretches[r], a, *ramp);
    }
    if (any) out.push_back(std::move(found));
  }
  return out;
}

/// Adds to the gap before what ramps do below the band.
void count_ramps(const std::vector<Stretch>& stretches, std::size_t holdout_from, Diagnosis& d) {
  for (FoundEffect& found : d.effects) {
    if (found.ramp_mps3.empty()) continue;
    found.before = found.after = 0;
    std::size_t held = 0;
    for (std::size_t r = 0; r < d.before.size(); ++r) {
      const Stretch& s = stretches[r];
      const Index axis = found.chosen.place.channel;
      const double length = std::max(s.seconds() - found.ramp_from_s[r], 0.0);
      const double share = length / s.seconds();
      // Of slope max(t - from, 0) about its mean.
      const double square =
          std::pow(found.ramp_mps3[r] * length, 2) * share * (1.0 / 3 - share / 4);
      const double intervals = static_cast<double>(s.intervals());
      const double power = 2 * s.spectrum.row(axis).squaredNorm() / (intervals * intervals);
      Gap& gap = d.before[r];
      gap.axis[axis] = std::hypot(gap.axis[axis], std::sqrt(square / std::max(power, 1e-300)));
      if (gap.axis[axis] > gap.worst) {
        gap.worst = gap.axis[axis];
        gap.worst_axis = static_cast<int>(axis);
      }
      const double all = 2 * s.spectrum.squaredNorm() / (intervals * intervals);
      gap.overall = std::hypot(gap.overall, std::sqrt(square / std::max(all, 1e-300)));
      if (r < holdout_from) continue;
      ++held;
      found.before += gap.overall;
      found.after += d.after[r].overall;
    }
    if (held > 0) {
      found.before /= static_cast<double>(held);
      found.after /= static_cast<double>(held);
    }
  }
}

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

Eigen::VectorXd fitted_linear(const Plant& plant, const std::vector<Stretch>& stretches,
                              const Tolerances& tolerances) {
  const FitResult fit = Fitter(plant, stretches, tolerances).fit(initial_model(plant), {}, {});
  return fit.good ? fit.model.theta : Eigen::VectorXd();
}

Diagnosis diagnose(const Plant& plant, const std::vector<Stretch>& stretches,
                   const DiagnosisOptions& options) {
  std::vector<Stretch> straight = stretches;
  const std::vector<FoundEffect> ramps = take_ramps(plant, options, straight);
  Diagnosis out = Search(plant, straight, options).run(ramps);
  count_ramps(straight, options.holdout_from, out);
  return out;
}

}  // namespace framewatch
