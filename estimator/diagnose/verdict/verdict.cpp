// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/model/bias.h"
#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/trials/refit.h"
#include "estimator/diagnose/verdict/nearest_law.h"

namespace framewatch::estimator {
using Eigen::Index;

bool fits_separately(const Fitter& fitter, const Model& linear, double ratio_before) {
  double misfit = 0, noise = 0;
  for (const RecordSegment& s : fitter.segments()) {
    const std::vector<RecordSegment> one{s};
    const Fitter alone = fitter.with(one);
    const FitResult fitted = alone.fit(linear, {}, {});
    if (!fitted.good) return false;
    misfit += fitted.total_misfit();
    noise += alone.expected(0, fitted.model);
  }
  return misfit / noise - 1 < fitter.settings().separate * (ratio_before - 1);
}

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

namespace {

std::vector<RecordSegment> training(const Fitter& fitter, std::size_t holdout_from) {
  const std::vector<RecordSegment>& all = fitter.segments();
  return {all.begin(), all.begin() + static_cast<long>(std::min(holdout_from, all.size()))};
}

}  // namespace

namespace {

/// Returns starts of the model with the first `count` of the effects.
std::vector<Model> starts_with(const std::vector<Model>& found, const Diagnosis& diagnosis,
                               std::size_t count, const Plant& plant, double small_start) {
  std::vector<Model> out;
  for (const Model& model : found) {
    out.push_back(
        without_effects(model, diagnosis.effects, count, diagnosis.effects.size(), plant));
    // Stiffnesses that compensate for a missing effect may be far off, and so may an effect fitted
    // together with the others.
    out.push_back(out.back());
    out.back().theta = diagnosis.linear.theta;
    out.push_back(out.back());
    for (std::size_t e = 0; e < count; ++e)
      if (const int index = diagnosis.effects[e].index; index >= 0)
        scale_amplitude(small_start, out.back().effects[static_cast<std::size_t>(index)]);
  }
  return out;
}

}  // namespace

void set_gaps(const Fitter& fitter, const DiagnosisOptions& options, Diagnosis& out) {
  const std::size_t holdout_from = options.holdout_from, count = out.effects.size();
  // Infinite if a run diverges.
  const auto held_out = [&](const std::vector<Gap>& gaps) {
    return gaps.size() < fitter.segments().size() ? std::numeric_limits<double>::infinity()
                                                  : mean_gap(gaps, holdout_from);
  };
  const std::vector<RecordSegment> seen = training(fitter, holdout_from);
  const Fitter train = fitter.with(seen);
  std::vector<Model> found{out.model};
  if (out.trained) found.push_back(*out.trained);
  // Without any effect, with the first of them, with the first two, ...
  std::vector<std::vector<Gap>> gaps(count + 1);
  std::vector<Model> models(count + 1);
  run_all(options.parallel, static_cast<int>(gaps.size()), [&](int i) {
    const auto with = static_cast<std::size_t>(i);
    const bool ramp = with > 0 && !out.effects[with - 1].ramp_mps3.empty();
    if (ramp && with < count) return;
    const std::vector<Model> starts =
        with == 0 ? linear_starts(fitter.plant(), out.linear)
        : with == count
            ? found
            : starts_with(found, out, with, fitter.plant(), fitter.settings().small_start);
    models[with] = judged_fit(train, starts, fitter.settings().long_steps, fitter.within()).model;
    gaps[with] = gaps_of(fitter, models[with]);
  });
  out.before = gaps.front();
  out.after = gaps.back();
  out.before_model = models.front();
  out.after_model = models.back();
  if (count == 0) return;
  const std::vector<Gap> all = gaps_of(fitter, out.model);
  if (held_out(out.after) > fitter.settings().undetermined * held_out(all)) {
    out.after = all;
    out.after_model = out.model;
    out.after_of_all = true;
  }
  double gap = mean_gap(out.before, holdout_from);
  for (std::size_t i = 0; i < count; ++i) {
    FoundEffect& effect = out.effects[i];
    effect.before = gap;
    if (i + 1 == count)
      gap = mean_gap(out.after, holdout_from);
    else if (const double with = held_out(gaps[i + 1]); std::isfinite(with))
      gap = with;
    effect.after = gap;
  }
}

void set_gaps_of_all(const Fitter& fitter, std::size_t holdout_from, Diagnosis& out) {
  out.before_model = out.linear;
  out.after_model = out.effects.empty() ? out.linear : out.model;
  out.before = gaps_of(fitter, out.before_model);
  out.after = out.effects.empty() ? out.before : gaps_of(fitter, out.after_model);
  out.after_of_all = true;
  // The gaps of models with some of the effects are not known: the last one closes all of it.
  for (FoundEffect& effect : out.effects)
    effect.before = effect.after = mean_gap(out.before, holdout_from);
  if (!out.effects.empty()) out.effects.back().after = mean_gap(out.after, holdout_from);
}

namespace {

bool is_arbitrary(const Model& model) {
  return std::any_of(model.effects.begin(), model.effects.end(),
                     [](const ModelEffect& e) { return e.form == LawForm::broadband; });
}

/// Returns true if no record is worse.
bool no_worse(const std::vector<Gap>& before, const std::vector<Gap>& after, double same_gap) {
  if (after.size() < before.size()) return false;
  for (std::size_t r = 0; r < before.size(); ++r)
    if (after[r].overall > (1 + same_gap) * before[r].overall || after[r].overall > 1) return false;
  return true;
}

}  // namespace

void set_leading(const Fitter& fitter, const DiagnosisOptions& options, Diagnosis& out) {
  const std::size_t holdout_from = options.holdout_from;
  if (!out.effects.empty() || out.ratio_after < fitter.settings().near_noise) return;
  const std::vector<RecordSegment> seen = training(fitter, holdout_from);
  const Fitter train = fitter.with(seen);
  std::vector<const Trial*> tried;
  for (const Trial& t : out.rejected)
    if (t.outcome == TrialOutcome::fitted && !is_arbitrary(t.model) &&
        tried.size() < fitter.settings().finalists)
      tried.push_back(&t);
  std::vector<std::vector<Gap>> gaps(tried.size());
  run_all(options.parallel, static_cast<int>(tried.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const JudgedFit fit =
        judged_fit(train, {tried[at]->model}, fitter.settings().rough_steps, fitter.within());
    gaps[at] = gaps_of(fitter, fit.model);
  });
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (!no_worse(out.before, gaps[i], fitter.settings().same_gap)) continue;
    const LeadingLaw law{*tried[i], mean_gap(out.before, holdout_from),
                         mean_gap(gaps[i], holdout_from)};
    if (law.after < fitter.settings().leads * law.before) out.leading.push_back(law);
  }
  std::stable_sort(out.leading.begin(), out.leading.end(),
                   [](const LeadingLaw& a, const LeadingLaw& b) { return a.after < b.after; });
}

namespace {

bool is_surrogate(const SearchSettings& settings, std::size_t holdout_from, const Diagnosis& out) {
  if (out.effects.size() != 1 || out.effects.front().index < 0) return false;
  const FoundEffect& only = out.effects.front();
  const PlaceKind at = only.chosen.place.kind;
  const bool one_place = at == PlaceKind::frame || at == PlaceKind::panel ||
                         at == PlaceKind::node || at == PlaceKind::node_pair;
  return one_place && out.model.effects[static_cast<std::size_t>(only.index)].element_law() &&
         mean_gap(out.after, holdout_from) >
             settings.near_floor * mean_floor(out.after, holdout_from) &&
         !is_of_the_kind_there(settings, only.chosen, out.where);
}

}  // namespace

bool withdraw_worse(const SearchSettings& settings, std::size_t holdout_from, Diagnosis& out) {
  if (out.effects.empty()) return false;
  const double before = mean_gap(out.before, holdout_from),
               after = mean_gap(out.after, holdout_from);
  const bool beyond =
      out.after.size() < out.before.size() ||  // a run diverges
      std::any_of(out.after.begin(), out.after.end(), [](const Gap& g) { return g.overall > 1; });
  const bool worse = beyond || after > settings.nearly_best * before;
  if (!worse && !is_surrogate(settings, holdout_from, out)) return false;
  for (const FoundEffect& e : out.effects) out.rejected.push_back(e.chosen);
  out.effects.clear();
  out.reason =
      worse ? "the model with the effects found is worse than the model without them"
            : "the nearest law leaves too large a gap, and is not known to be of the kind of "
              "force at its place";
  out.after = out.before;
  out.after_model = out.before_model;
  out.after_of_all = false;
  out.ratio_after = out.ratio_before;
  return true;
}

namespace {

/// Returns the largest gap of a record over its floor.
double worst_gap(const std::vector<Gap>& gaps) {
  double out = 0;
  for (const Gap& g : gaps) out = std::max(out, g.overall / std::max(g.overall_floor, 1e-12));
  return out;
}

}  // namespace

void mark_approximate(const Fitter& fitter, Diagnosis& out) {
  const bool misfits = out.noise_by_place || out.ratio_after >= 1 + chance_of(fitter, out.model);
  if (!misfits || worst_gap(out.after) < fitter.settings().at_floor) return;
  for (FoundEffect& e : out.effects) {
    if (!e.ramp_mps3.empty()) continue;
    e.approximate = true;
    e.confidence = std::min(e.confidence, kDoubtful);
  }
}

Grade grade_of(const FoundEffect& effect) {
  return effect.confidence >= kEstablished && !effect.approximate && effect.like.empty()
             ? Grade::established
             : Grade::leading;
}

const char* grade_word(Grade grade) {
  return grade == Grade::established ? "established" : "leading";
}

void judge(const Fitter& fitter, Diagnosis& out) {
  double gap = 0, floor = 0;
  for (const Gap& g : out.after) {
    gap += g.overall;
    floor += g.overall_floor;
  }
  const bool fits = out.ratio_after < fitter.settings().adequate ||
                    worst_gap(out.after) < fitter.settings().at_floor;
  if (out.effects.empty()) {
    const bool adequate =
        fits && (worst_gap(out.before) < fitter.settings().near_floor || out.rejected.empty());
    out.verdict = adequate ? Verdict::adequate : Verdict::unexplained;
    if (!adequate && out.reason.empty() && fits_separately(fitter, out.linear, out.ratio_before))
      out.reason =
          "each record alone fits a linear building, but all together do not: they are of "
          "different "
          "buildings, or the building changed between them; diagnose the records of each state "
          "alone, or measure again in one state";
    return;
  }
  const double fraction =
      (out.ratio_before - out.ratio_after) / std::max(out.ratio_before - 1, 1e-9);
  // An arbitrary force does as well as any law, so it explains nothing. Neither does a nearest law.
  const bool surrogate =
      std::any_of(out.effects.begin(), out.effects.end(), [&](const FoundEffect& e) {
        return e.nearest ||
               (e.index >= 0 &&
                out.model.effects[static_cast<std::size_t>(e.index)].form == LawForm::broadband);
      });
  // A linear effect has no free shape, so a residual beyond chance belongs to another effect.
  const bool another =
      std::any_of(out.effects.begin(), out.effects.end(), [&](const FoundEffect& e) {
        return e.index >= 0 && e.approximate &&
               !out.model.effects[static_cast<std::size_t>(e.index)].element_law();
      });
  out.verdict = !surrogate && !another &&
                        (fits || (fraction > fitter.settings().explains &&
                                  gap < fitter.settings().near_floor * floor))
                    ? Verdict::explained
                    : Verdict::partly_explained;
}

std::vector<FoundEffect> remove_ramps(const Plant& plant, const DiagnosisOptions& options,
                                      std::vector<RecordSegment>& segments) {
  for (const Effect& e : options.known)
    if (e.kind == EffectKind::bias_drift)
      for (RecordSegment& s : segments)
        s = without_ramp(s, e.place.channel, {e.value("ramp_mps3"), e.value("from_s"), 0});
  std::vector<FoundEffect> out;
  if (std::find(options.without.begin(), options.without.end(), EffectKind::bias_drift) !=
      options.without.end())
    return out;
  const std::vector<RecordSegment> whole = segments;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    FoundEffect found;
    found.chosen.kind = EffectKind::bias_drift;
    found.chosen.place.kind = PlaceKind::channel;
    found.chosen.place.channel = static_cast<int>(a);
    found.chosen.fraction = 1;
    found.confidence = 0.99;
    bool any = false;
    for (std::size_t r = 0; r < segments.size(); ++r) {
      const auto ramp = find_ramp(plant, whole[r], a);
      found.ramp_mps3.push_back(ramp ? ramp->slope : 0);
      found.ramp_from_s.push_back(ramp ? ramp->from_s : 0);
      found.drift_rms_mps2.push_back(ramp ? ramp->rms : 0);
      if (!ramp) continue;
      any = true;
      segments[r] = without_ramp(segments[r], a, *ramp);
    }
    if (any) out.push_back(std::move(found));
  }
  return out;
}

namespace {

/// outputs: number of axes in Gap::overall.
void add_ramp(const RecordSegment& s, Index axis, double slope, double from_s, double rms,
              Index outputs, Gap& gap) {
  const double length = std::max(s.seconds() - from_s, 0.0), share = length / s.seconds();
  // Mean square of slope max(t - from, 0) about its mean, unless the drift is another curve.
  const double square =
      std::max(std::pow(slope * length, 2) * share * (1.0 / 3 - share / 4), rms * rms);
  const double intervals = static_cast<double>(s.intervals());
  const double power = 2 * s.spectrum.row(axis).squaredNorm() / (intervals * intervals);
  const double all = static_cast<double>(outputs) * gap.measured_rms * gap.measured_rms;
  gap.axis[axis] = std::hypot(gap.axis[axis], std::sqrt(square / std::max(power, 1e-300)));
  if (gap.axis[axis] > gap.worst) {
    gap.worst = gap.axis[axis];
    gap.worst_axis = static_cast<int>(axis);
  }
  gap.overall = std::hypot(gap.overall, std::sqrt(square / std::max(all, 1e-300)));
}

}  // namespace

void add_ramps_to_gaps(const Plant& plant, const std::vector<RecordSegment>& segments,
                       std::size_t holdout_from, Diagnosis& d) {
  Index outputs = 0;
  for (Index a = 0; a < plant.axis_count(); ++a) outputs += is_output(plant, a);
  // Starts with the last one: its gap is the one before the search.
  for (auto found = d.effects.rbegin(); found != d.effects.rend(); ++found) {
    if (found->ramp_mps3.empty()) continue;
    found->after = mean_gap(d.before, holdout_from);
    for (std::size_t r = 0; r < d.before.size(); ++r)
      add_ramp(segments[r], found->chosen.place.channel, found->ramp_mps3[r], found->ramp_from_s[r],
               r < found->drift_rms_mps2.size() ? found->drift_rms_mps2[r] : 0, outputs,
               d.before[r]);
    found->before = mean_gap(d.before, holdout_from);
  }
}

}  // namespace framewatch::estimator
