#include "daemon/tools/diagnosis/diagnose_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include "daemon/tools/diagnosis/kind_section.h"
#include "daemon/tools/diagnosis/noise_beyond.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "estimator/diagnose/verdict/verdict.h"

namespace framewatch::daemon {
namespace {

/// What an effect does, for people who do not know its name; in the order of EffectKind.
constexpr std::array kPlainNames = {
    "a stiffness that changes with the deformation",
    "a stiffness that differs between the two directions",
    "yielding at a sharp limit",
    "gradual yielding",
    "yielding with slip about zero",
    "dry friction",
    "a damping that grows with speed",
    "a frame that softens or damps as it moves more",
    "a stop on one side",
    "play between two stops",
    "the pull of the weight on the leaning building",
    "a mass that was not counted",
    "a mass on a spring of its own",
    "rocking of the foundation",
    "bending of the whole frame",
    "another spring",
    "another damper",
    "a damping of the mode itself",
    "a sudden loss of stiffness",
    "a slow change of stiffness",
    "a floor that gives way in its plane",
    "a force that nobody measures",
    "a sensor of another scale",
    "a sensor turned round",
    "a sensor mounted askew",
    "a sensor that is late",
    "a sensor beyond its range",
    "a sensor whose zero moves",
    "two sensors exchanged",
};
static_assert(kPlainNames.size() == static_cast<std::size_t>(estimator::EffectKind::swapped) + 1);

}  // namespace

std::string gap_percent(double share) {
  return fmt::format("{:.2f} %", 100 * share);
}

std::string with_capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string effect_words(const DiagnoseOutput& o, const estimator::FoundEffect& f) {
  std::string name(name_of(f.chosen.kind));
  std::replace(name.begin(), name.end(), '_', ' ');
  return fmt::format("{}{} at {} ({})", f.approximate ? "something like " : "", name,
                     place_text(f.chosen.place, o.plant.structure, o.plant.axes),
                     kPlainNames[static_cast<std::size_t>(f.chosen.kind)]);
}

std::string confidence_words(const estimator::FoundEffect& f) {
  const char* how = f.confidence >= 0.95  ? "sure"
                    : f.confidence >= 0.8 ? "likely"
                                          : "possible, others are nearly as good";
  const std::string sure = fmt::format("{} (confidence {:.0f} %)", how, 100 * f.confidence);
  if (std::isnan(f.chosen.fraction)) return sure;
  return fmt::format("{}, it explains {:.0f} % of what the sensors' noise does not", sure,
                     100 * f.chosen.fraction);
}

double share_of_gap(const DiagnoseOutput& o, double fall) {
  const double before = estimator::mean_gap(o.diagnosis.before, o.holdout_from);
  return before > 0 ? fall / before : 0;
}

std::string leading_sentence(const DiagnoseOutput& o) {
  if (o.diagnosis.leading.empty()) return "";
  const estimator::LeadingLaw& best = o.diagnosis.leading.front();
  estimator::FoundEffect found;
  found.chosen = best.trial;
  return fmt::format(
      "Of the known effects the leading one is {}: with it the held-out gap falls from {} to {}. "
      "It "
      "is not established: more is left than it should leave.",
      effect_words(o, found), gap_percent(best.before), gap_percent(best.after));
}

std::string verdict_sentence(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  std::string missing;
  for (const estimator::FoundEffect& f : d.effects)
    missing += (missing.empty() ? "" : ", and ") + effect_words(o, f);
  switch (d.verdict) {
    case estimator::Verdict::adequate:
      return missing.empty()
                 ? "Nothing is missing: the model explains the measurement as well as the sensors' "
                   "noise allows."
                 : "The model explains the measurement with " + missing + ".";
    case estimator::Verdict::explained:
      return "The model lacks " + missing + "; with it the measurement is explained.";
    case estimator::Verdict::partly_explained:
      return "The model lacks " + (missing.empty() ? std::string("something") : missing) +
             "; something else is missing too.";
    case estimator::Verdict::unexplained:
      break;
  }
  if (d.where.empty())
    return "Something is missing in the model, and it is not known what or where.";
  return "Something is missing in the model, most likely at " +
         place_text(d.where.front().place, o.plant.structure, o.plant.axes) +
         ", and no known effect explains it.";
}

const char* gap_unit(const DiagnoseOutput& o) {
  if (o.plant.prescribed) return "N";
  for (const estimator::RecordSegment& s : o.segments)
    for (Eigen::Index a = 0; a < o.plant.axis_count(); ++a)
      if (s.is_displaced(a)) return "m";
  return "m/s^2";
}

std::string driver_words(const DiagnoseOutput& o) {
  bool base = false, force = false;
  for (Eigen::Index a = 0; a < o.plant.axis_count(); ++a) {
    force = force || o.plant.is_force(a);
    base = base || o.plant.axes[static_cast<std::size_t>(a)].story == 0;
  }
  if (!force || o.plant.prescribed) return "motion of the base";
  return base ? "force and motion of the base" : "force";
}

std::string denominator_words(const DiagnoseOutput& o) {
  const std::string_view unit = gap_unit(o);
  const Eigen::VectorXd& w = o.segments.front().w;
  return fmt::format("the rms of the measured {} from {:.3g} to {:.3g} Hz{}",
                     unit == "N"   ? "force"
                     : unit == "m" ? "displacement"
                                   : "acceleration of the floors",
                     w[0] / (2 * M_PI), w[w.size() - 1] / (2 * M_PI),
                     unit == "m/s^2" ? ", all channels together" : "");
}

std::string gap_sentence(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  const bool held_out = o.holdout_from < d.before.size() && o.holdout_from < d.after.size();
  const std::size_t from = held_out ? o.holdout_from : 0;
  return fmt::format(
      "In the {} simulation and measurement differ by {} before and {} after; noise "
      "alone would make {} (of {}).{}",
      held_out ? "held-out records" : "records", gap_percent(estimator::mean_gap(d.before, from)),
      gap_percent(estimator::mean_gap(d.after, from)),
      gap_percent(estimator::mean_floor(d.before, from)), denominator_words(o),
      o.plant.unread.cols() == 0
          ? ""
          : " Compared are the channels that there are: floors without one follow from the others, "
            "stories between measured floors share one factor, and laws inside such groups are "
            "not looked for.");
}

std::string damping_sentence(const DiagnoseOutput& o) {
  std::string ratios;
  for (const estimator::Effect& e : modal_damping_effects(o.diagnosis.model))
    ratios += fmt::format("{}{:.2g} % in mode {}", ratios.empty() ? "" : ", ",
                          100 * e.value("damping_ratio"), e.place.mode);
  return ratios.empty() ? ""
                        : "The damping is not that of dashpots between floors alone: beside them "
                          "modes have damping ratios of their own (" +
                              ratios + ").";
}

std::string diagnosis_text(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  std::string out = verdict_sentence(o) + "\n  " + gap_sentence(o) + "\n";
  if (const std::string text = damping_sentence(o); !text.empty()) out += "  " + text + "\n";
  if (const std::string text = noise_sentence(o); !text.empty()) out += "  " + text + "\n";
  for (const estimator::FoundEffect& f : d.effects)
    out += fmt::format("  {}, {}: {}; it takes {:.0f} % of the gap\n", grade_word(grade_of(f)),
                       effect_words(o, f), confidence_words(f),
                       100 * share_of_gap(o, f.before - f.after));
  if (const std::string text = leading_sentence(o); !text.empty()) out += "  " + text + "\n";
  if (const std::string text = kind_sentence(o); d.effects.empty() && !text.empty())
    out += "  " + text + "\n";
  if (!d.reason.empty()) out += "  " + d.reason + "\n";
  return out;
}

}  // namespace framewatch::daemon
