// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/several_causes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/propose/name_of_fit.h"
#include "estimator/diagnose/trials/refit.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trial_names.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {
namespace {

/// Indices of laws, in the order of their effects in a model.
using Members = std::vector<std::size_t>;

constexpr std::size_t kMaxWork = 60;  ///< laws times equations
struct CauseSet {
  Members members;
  Model model;  ///< of the training records
  std::vector<Gap> gaps;
  double held_out = std::numeric_limits<double>::infinity();  ///< mean gap
  double all = std::numeric_limits<double>::infinity();       ///< of all records
  bool named = false;                                         ///< its names are allowed
};

/// Returns true if `other` is hysteresis that got no free run because `fitted` was better at its
/// place. With other causes it may do better.
bool yields_otherwise(const TrialContext& c, const Trial& fitted, const Trial& other) {
  const auto hysteretic = [&](const Trial& t) {
    return t.model.effects.size() > c.now.model.effects.size() &&
           is_hysteretic(t.model.effects.back().form);
  };
  return other.outcome == TrialOutcome::screened_out && fitted.place == other.place &&
         hysteretic(fitted) && hysteretic(other);
}

/// Returns laws that may be causes, best first, one of every name and place.
std::vector<const Trial*> possible(const TrialContext& c, const std::vector<Trial>& tried) {
  const auto equations = static_cast<std::size_t>(c.fitter.plant().equations());
  const SearchSettings& settings = c.settings();
  const std::size_t most =
      std::max(settings.finalists, std::min(kMaxWork / equations, settings.causes));
  std::vector<const Trial*> out;
  for (const Trial& t : tried) {
    const bool otherwise = std::any_of(out.begin(), out.end(),
                                       [&](const Trial* o) { return yields_otherwise(c, *o, t); });
    if (t.second || (t.outcome != TrialOutcome::fitted && !otherwise)) continue;
    const bool anything = t.kind == EffectKind::unmeasured_force || t.kind == EffectKind::clipping;
    const bool again = std::any_of(out.begin(), out.end(), [&](const Trial* o) {
      return o->kind == t.kind && o->place == t.place;
    });
    if (anything || again || is_excluded(c, t.kind)) continue;
    // Effects of the whole building are rarely the best alone, but often act together with others.
    if (out.size() < most || otherwise || t.place.kind == PlaceKind::building) out.push_back(&t);
  }
  return out;
}

/// Start values of an effect that is added to a model.
enum class Start {
  changed,  ///< stiffnesses and dampings changed by what the trial changed
  trial,    ///< those of the trial
  little,   ///< those of the model, and a small amplitude of the effect
};

/// Returns a model with the effect of a trial added.
Model extended(const TrialContext& c, const Model& model, const Trial& t, Start start) {
  Model out = model;
  const auto known = static_cast<std::ptrdiff_t>(c.now.model.effects.size());
  out.effects.insert(out.effects.end(), t.model.effects.begin() + known, t.model.effects.end());
  free_shapes(out);
  const double part = start == Start::little ? c.settings().small_start : 1;
  for (std::size_t e = model.effects.size(); e < out.effects.size(); ++e)
    scale_amplitude(part, out.effects[e]);
  const auto add = [&](std::vector<int> Model::*freed, Eigen::VectorXd Model::*errors) {
    for (const int axis : t.model.*freed) {
      if (std::find((out.*freed).begin(), (out.*freed).end(), axis) != (out.*freed).end()) continue;
      (out.*freed).push_back(axis);
      (out.*errors)[axis] = part * (t.model.*errors)[axis];
    }
  };
  add(&Model::free_gain, &Model::gain);
  add(&Model::free_clock, &Model::clock_s);
  if (start == Start::trial) {
    out.theta = t.model.theta;
    out.mass_change = t.model.mass_change;
  } else if (start == Start::changed) {
    out.theta = (out.theta + t.model.theta - c.now.model.theta)
                    .cwiseMax(c.settings().small_start * c.fitter.plant().design);
  }
  return out;
}

class Selection {
 public:
  Selection(const TrialContext& context, const std::vector<Trial>& tried, std::size_t holdout_from)
      : context_(context),
        settings_(context.settings()),
        tried_(possible(context, tried)),
        holdout_from_(std::min(holdout_from, context.fitter.segments().size())),
        seen_(context.fitter.segments().begin(),
              context.fitter.segments().begin() + static_cast<std::ptrdiff_t>(holdout_from_)),
        train_(context.fitter.with(seen_)) {}

  SeveralCauses run() {
    if (tried_.empty() || holdout_from_ == context_.fitter.segments().size()) return {};
    const std::vector<Model> starts = linear_starts(context_.fitter.plant(), context_.now.model);
    none_ = judged({}, judged_fit(train_, starts, settings_.long_steps, context_.parallel).model);
    CauseSet best = none_;
    std::vector<CauseSet> kept{none_};
    for (std::size_t size = 1; size <= settings_.finalists && !kept.empty(); ++size) {
      context_.progress("several causes");
      kept = larger(kept);
      const auto leads =
          std::find_if(kept.begin(), kept.end(), [&](const CauseSet& s) { return may_lead(s); });
      if (leads != kept.end() && is_worth(*leads, best)) best = *leads;
    }
    return result(without_redundant(std::move(best)));
  }

 private:
  CauseSet judged(Members members, Model model) const {
    CauseSet out;
    out.members = std::move(members);
    out.gaps = gaps_of(context_.fitter, model);
    if (out.gaps.size() == context_.fitter.segments().size()) {
      out.held_out = mean_gap(out.gaps, holdout_from_);
      out.all = mean_gap(out.gaps, 0);
    }
    Trial trial;
    if (!out.members.empty()) trial.kind = tried_[out.members.back()]->kind;
    trial.model = out.model = std::move(model);
    out.named = may_be_named(context_, trial);
    return out;
  }

  CauseSet finished(const CauseSet& s) const {
    std::vector<Model> starts{s.model};
    if (std::optional<Model> again = restarted(s)) starts.push_back(std::move(*again));
    return judged(s.members, free_run_fit(train_, starts, settings_.steps, true).model);
  }

  /// Returns the set's model with the trials' shapes where shapes have reached their bounds,
  /// because the fit may have passed other minima on the way. Returns nullopt if no shape has
  /// reached a bound.
  std::optional<Model> restarted(const CauseSet& s) const {
    Model out = s.model;
    bool any = false;
    for (std::size_t i = 0; i < s.members.size(); ++i) {
      const Trial& t = *tried_[s.members[i]];
      if (is_axis_error(t.kind)) continue;
      std::vector<LawParameter>& now = out.effects[effect_of(s, i)].parameters;
      const std::vector<LawParameter>& then = t.model.effects.back().parameters;
      const bool bound =
          has_law(t) && std::any_of(now.begin() + 1, now.end(),
                                    [](const LawParameter& k) { return k.free && at_bound(k); });
      for (std::size_t k = 1; bound && k < now.size(); ++k) now[k].value = then[k].value;
      any = any || bound;
    }
    return any ? std::optional(out) : std::nullopt;
  }

  /// Returns true if the names are allowed and no record's gap grows.
  bool may_lead(const CauseSet& s) const {
    if (!s.named || s.gaps.size() != none_.gaps.size()) return false;
    for (std::size_t r = 0; r < s.gaps.size(); ++r)
      if (s.gaps[r].overall > std::min(none_.gaps[r].overall, 1.0)) return false;
    return true;
  }

  /// Returns true if a larger set justifies its additional causes by the gap of all records, and by
  /// half as much in the held-out ones.
  bool is_worth(const CauseSet& larger, const CauseSet& s) const {
    const auto more = static_cast<int>(larger.members.size() - s.members.size());
    const double takes = s.members.empty() ? settings_.leads * std::pow(settings_.pays, more - 1)
                                           : std::pow(settings_.pays, more);
    return larger.all < takes * s.all && larger.held_out < 0.5 * (1 + takes) * s.held_out;
  }

  bool has_law(const Trial& t) const {
    return t.model.effects.size() > context_.now.model.effects.size() &&
           t.model.effects.back().element_law();
  }

  /// Returns true if a cause is distinguishable from those of a set. Two laws at one place are one
  /// law.
  bool joins(const Members& members, std::size_t cause) const {
    const Trial& t = *tried_[cause];
    return std::none_of(members.begin(), members.end(), [&](std::size_t i) {
      return i == cause ||
             (same_spot(t.place, tried_[i]->place) && has_law(t) && has_law(*tried_[i]));
    });
  }

  struct Extension {
    Members members;
    const CauseSet* from = nullptr;
    std::size_t cause = 0;
  };

  std::vector<Extension> extensions(const std::vector<CauseSet>& sets) const {
    std::vector<Extension> out;
    for (const CauseSet& s : sets)
      for (std::size_t i = 0; i < tried_.size(); ++i) {
        Members members = s.members;
        members.push_back(i);
        const bool again = std::any_of(out.begin(), out.end(), [&](const Extension& e) {
          return std::is_permutation(e.members.begin(), e.members.end(), members.begin(),
                                     members.end());
        });
        if (joins(s.members, i) && !again) out.push_back({std::move(members), &s, i});
      }
    return out;
  }

  /// Returns the start of an extension with the smallest gap.
  Model best_start(const Extension& e) const {
    Model out;
    double least = std::numeric_limits<double>::infinity();
    for (const Start start : {Start::changed, Start::trial, Start::little}) {
      Model model = extended(context_, e.from->model, *tried_[e.cause], start);
      const double gap = rms_gap(train_, model);
      if (out.theta.size() > 0 && gap >= least) continue;
      out = std::move(model);
      least = gap;
    }
    return out;
  }

  /// Returns sets with one more cause than the given ones, best first. Fits all of them a step, the
  /// better half a few more, then the best to convergence.
  std::vector<CauseSet> larger(const std::vector<CauseSet>& sets) {
    const std::vector<Extension> all = extensions(sets);
    std::vector<CauseSet> out(all.size());
    run_all(context_.parallel, static_cast<int>(all.size()), [&](int i) {
      const Extension& e = all[static_cast<std::size_t>(i)];
      out[static_cast<std::size_t>(i)] =
          judged(e.members, free_run_fit(train_, {best_start(e)}, 1, false).model);
    });
    const auto best_first = [&] {
      std::stable_sort(out.begin(), out.end(),
                       [](const CauseSet& a, const CauseSet& b) { return a.all < b.all; });
    };
    best_first();
    if (const std::size_t half = (out.size() + 1) / 2; half > settings_.laws) out.resize(half);
    run_all(context_.parallel, static_cast<int>(out.size()), [&](int i) {
      CauseSet& s = out[static_cast<std::size_t>(i)];
      s = judged(s.members, free_run_fit(train_, {s.model}, settings_.first_steps, false).model);
    });
    // A set whose values do not match its names is another law. Fitted records count too, because
    // with few held-out ones several sets do nearly as well.
    const auto sort = [&] {
      std::erase_if(out, [](const CauseSet& s) { return !s.named || !std::isfinite(s.held_out); });
      best_first();
    };
    sort();
    if (out.size() > settings_.finalists) out.resize(settings_.finalists);
    run_all(context_.parallel, static_cast<int>(out.size()), [&](int i) {
      CauseSet& s = out[static_cast<std::size_t>(i)];
      s = finished(s);
    });
    sort();
    all_.insert(all_.end(), out.begin(), out.end());
    return out;
  }

  /// Returns the set without one of its members, fitted.
  CauseSet without(const CauseSet& s, std::size_t member) const {
    CauseSet out = s;
    out.members.erase(out.members.begin() + static_cast<std::ptrdiff_t>(member));
    const Trial& t = *tried_[s.members[member]];
    if (is_axis_error(t.kind)) {
      hold_axis(context_.fitter.plant(), t.place.channel, out.model);
    } else {
      out.model.effects.erase(out.model.effects.begin() +
                              static_cast<std::ptrdiff_t>(effect_of(s, member)));
    }
    return finished(out);
  }

  /// Returns the index of a member among the effects of its set's model.
  std::size_t effect_of(const CauseSet& s, std::size_t member) const {
    std::size_t out = context_.now.model.effects.size();
    for (std::size_t i = 0; i < member; ++i) out += !is_axis_error(tried_[s.members[i]]->kind);
    return out;
  }

  /// Removes redundant members.
  CauseSet without_redundant(CauseSet best) const {
    for (std::size_t i = 0; i < best.members.size() && best.members.size() > 1;) {
      CauseSet less = without(best, i);
      const bool redundant = may_lead(less) && !is_worth(best, less);
      if (redundant) best = std::move(less);
      i = redundant ? 0 : i + 1;
    }
    return best;
  }

  /// Returns the names of causes that do nearly as well as replacements of a set's member.
  std::vector<EffectKind> like(const CauseSet& best, std::size_t member) const {
    std::vector<EffectKind> out;
    const std::size_t own = best.members[member];
    const auto has = [](const CauseSet& s, std::size_t cause) {
      return std::find(s.members.begin(), s.members.end(), cause) != s.members.end();
    };
    for (const CauseSet& s : all_) {
      if (s.members.size() != best.members.size() ||
          s.held_out > settings_.nearly_best * best.held_out || has(s, own) || !may_lead(s))
        continue;
      Members others;
      for (const std::size_t i : s.members)
        if (!has(best, i)) others.push_back(i);
      const EffectKind kind = tried_[others.front()]->kind;
      if (others.size() == 1 && kind != tried_[own]->kind &&
          std::find(out.begin(), out.end(), kind) == out.end())
        out.push_back(kind);
    }
    return out;
  }

  SeveralCauses result(const CauseSet& best) const {
    SeveralCauses out;
    out.model = best.model;
    for (std::size_t i = 0; i < best.members.size(); ++i) {
      Cause cause{*tried_[best.members[i]], like(best, i)};
      if (!is_axis_error(cause.trial.kind))
        cause.trial.kind = name_of_fit(settings_, best.model.effects[effect_of(best, i)],
                                       context_.fitter.segments().front());
      out.causes.push_back(std::move(cause));
    }
    return out;
  }

  const TrialContext& context_;
  const SearchSettings& settings_;
  std::vector<const Trial*> tried_;
  std::size_t holdout_from_;
  std::vector<RecordSegment> seen_;
  Fitter train_;
  CauseSet none_;
  std::vector<CauseSet> all_;
};

}  // namespace

SeveralCauses several_causes(const TrialContext& context, const std::vector<Trial>& tried,
                             std::size_t holdout_from) {
  if (context.fitter.plant().is_large()) return {};
  return Selection(context, tried, holdout_from).run();
}

}  // namespace framewatch::estimator
