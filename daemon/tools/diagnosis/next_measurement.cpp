// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/next_measurement.h"

#include <algorithm>
#include <functional>

#include <fmt/core.h>

#include "estimator/diagnose/propose/law_kind.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/verdict/verdict.h"

namespace framewatch::daemon {
namespace {

using estimator::EffectKind;
using estimator::LawKind;
using estimator::PlaceKind;

constexpr double kNearPlace = 1.1;  ///< misfit at a place over that at the best

bool is_external(EffectKind kind) {
  return kind == EffectKind::unmeasured_force;
}

bool is_dissipative(EffectKind kind) {
  return estimator::is_of_kind(kind, LawKind::dissipative);
}

bool is_hysteretic(EffectKind kind) {
  return estimator::is_of_kind(kind, LawKind::hysteretic);
}

bool is_restoring(EffectKind kind) {
  return estimator::is_of_deformation(kind) || is_hysteretic(kind) || is_dissipative(kind);
}

bool is_mass(EffectKind kind) {
  return kind == EffectKind::extra_mass || kind == EffectKind::tuned_mass_damper;
}

/// Effects to tell apart, and the building they are in.
struct Between {
  const NamedEffect& best;
  const std::vector<NamedEffect>& rivals;
  const estimator::Structure& structure;
  const std::vector<estimator::SensorAxis>& axes;
  double peak_m;

  std::string place(const NamedEffect& e) const { return place_text(e.place, structure, axes); }
  /// Returns the first effect of all with the property; nullptr without one.
  const NamedEffect* find(const std::function<bool(EffectKind)>& is) const {
    if (is(best.kind)) return &best;
    const auto at = std::find_if(rivals.begin(), rivals.end(),
                                 [&](const NamedEffect& e) { return is(e.kind); });
    return at == rivals.end() ? nullptr : &*at;
  }
  /// Returns true if one has the property and another has not.
  bool differ(const std::function<bool(EffectKind)>& is) const {
    return find(is) && find([&](EffectKind k) { return !is(k); });
  }
};

std::string deformation(const Between& b) {
  return b.peak_m > 0 ? fmt::format(" beyond the {:.3g} mm of these records", 1e3 * b.peak_m) : "";
}

/// Returns the measurement that tells names apart.
std::string for_kinds(const Between& b) {
  if (b.differ(estimator::is_channel_effect))
    return fmt::format(
        "Exchange the sensor of {} for another one and record again: an error of the sensor goes "
        "with it, an effect of the building stays.",
        b.place(*b.find(estimator::is_channel_effect)));
  if (b.differ(is_external))
    return fmt::format(
        "Record the building while the ground rests and with machines off, then on: a force from "
        "outside at {} acts without motion of the base.",
        b.place(*b.find(is_external)));
  if (b.differ(estimator::changes_with_time))
    return "Record weak motion again: a stiffness that was lost stays lost, a law of the "
           "deformation gives the stiffness of small motion back.";
  if (b.differ(is_dissipative) && b.find(is_restoring))
    return fmt::format(
        "Push {} slowly to and fro: a force that grows with speed vanishes, friction, springs and "
        "yielding stay.",
        b.place(b.best));
  if (b.differ(is_hysteretic) && b.find(estimator::is_of_deformation))
    return fmt::format(
        "Push {} slowly to and fro and measure its force: yielding and friction enclose an area "
        "between load and unload, a spring returns on the same line.",
        b.place(b.best));
  if (b.differ(is_mass))
    return fmt::format(
        "Put a known mass of a few percent of the floor's at {} and record again: its effect tells "
        "mass from stiffness.",
        b.place(*b.find(is_mass)));
  const bool names = std::any_of(b.rivals.begin(), b.rivals.end(),
                                 [&](const NamedEffect& e) { return e.kind != b.best.kind; });
  if (names && is_restoring(b.best.kind))
    return fmt::format(
        "Record stronger motion, at least twice as large{}, and weaker motion: laws that agree at "
        "one amplitude differ at another.",
        deformation(b));
  if (names)
    return "Record motion with other frequencies, strong at each natural frequency: linear effects "
           "differ in how they change the modes.";
  return "";
}

/// Returns true if an axis reads this frame at its floor.
bool has_channel(const Between& b, const estimator::EffectPlace& place) {
  return std::any_of(b.axes.begin(), b.axes.end(), [&](const estimator::SensorAxis& a) {
    return a.story == place.story && a.frame == place.frame;
  });
}

/// Returns the measurement that tells places apart.
std::string for_places(const Between& b) {
  const auto other = std::find_if(b.rivals.begin(), b.rivals.end(), [&](const NamedEffect& e) {
    return !same_spot(e.place, b.best.place) && !estimator::is_channel_effect(e.kind);
  });
  if (other == b.rivals.end() || estimator::is_channel_effect(b.best.kind)) return "";
  for (const estimator::EffectPlace& p : {b.best.place, other->place}) {
    const bool of_frame = p.kind == PlaceKind::frame || p.kind == PlaceKind::node;
    if (!of_frame || has_channel(b, p)) continue;
    return fmt::format("Put a sensor on floor {}, frame {}: {} and {} differ there.", p.story,
                       b.structure.frame_name(p.frame), b.place(b.best), b.place(*other));
  }
  return fmt::format(
      "Record motion that deforms {} and {} differently: shake along another direction, push one "
      "of them, or excite a higher mode.",
      b.place(b.best), b.place(*other));
}

std::string joined(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : " ") + second;
}

NamedEffect named(const estimator::Trial& t) {
  return {t.kind, t.place};
}

/// Returns the largest deformation at a place; 0 if unknown.
double peak_at(const DiagnoseOutput& o, const estimator::EffectPlace& place) {
  for (const estimator::PlaceForce& f : o.diagnosis.evidence.forces)
    if (same_spot(f.place, place)) return f.peak_d_m;
  return 0;
}

std::string between(const DiagnoseOutput& o, const NamedEffect& best,
                    const std::vector<NamedEffect>& rivals) {
  return measurement_between(best, rivals, o.plant.structure, o.plant.axes, peak_at(o, best.place));
}

constexpr const char* kOtherStrengths =
    "Record motion of half and of twice the strength: it shows how the rest, which is more than "
    "noise, depends on the amplitude.";

std::string for_effect(const DiagnoseOutput& o, const estimator::FoundEffect& f) {
  if (grade_of(f) == estimator::Grade::established) return "";
  std::vector<NamedEffect> rivals;
  for (const EffectKind kind : f.like) rivals.push_back({kind, f.chosen.place});
  for (const estimator::Trial* t : near_rivals(o.diagnosis.settings, f, estimator::kEstablished))
    rivals.push_back(named(*t));
  return between(o, named(f.chosen), rivals);
}

/// Returns the measurement if nothing is named: between the best laws, or the best places.
std::string for_unnamed(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  std::vector<NamedEffect> names;
  for (const estimator::LeadingLaw& law : d.leading) names.push_back(named(law.trial));
  if (names.empty())
    for (const estimator::WhereEntry& w : d.where)
      if (w.ratio < kNearPlace * d.where.front().ratio)
        names.push_back({w.place.kind == PlaceKind::channel ? EffectKind::gain_error
                                                            : EffectKind::cubic_stiffness,
                         w.place});
  if (names.size() < 2) return "";
  return between(o, names.front(), {names.begin() + 1, names.end()});
}

}  // namespace

std::string measurement_between(const NamedEffect& best, const std::vector<NamedEffect>& rivals,
                                const estimator::Structure& structure,
                                const std::vector<estimator::SensorAxis>& axes, double peak_m) {
  if (rivals.empty()) return "";
  const Between b{best, rivals, structure, axes, peak_m};
  return joined(for_kinds(b), for_places(b));
}

std::string next_measurement(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  if (d.verdict == estimator::Verdict::adequate) return "";
  std::string out = d.effects.empty() ? for_unnamed(o) : "";
  bool approximate = d.effects.empty();
  for (const estimator::FoundEffect& f : d.effects) {
    if (out.empty()) out = for_effect(o, f);
    approximate = approximate || f.approximate || f.nearest;
  }
  return out.empty() && approximate ? kOtherStrengths : out;
}

}  // namespace framewatch::daemon
