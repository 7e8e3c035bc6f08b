// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/words.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "estimator/diagnose/verdict/verdict.h"

namespace framewatch::daemon {
namespace {

constexpr double kBeyond = 2;  // times the configured noise

double quietest(const std::vector<estimator::RecordSegment>& segments, Eigen::Index axis) {
  double least = std::numeric_limits<double>::infinity();
  for (const estimator::RecordSegment& s : segments)
    least = std::min(
        least,
        std::sqrt(estimator::quiet_noise_variance(s.accel.col(axis), s.rate_hz) / (s.rate_hz / 2)));
  return least;
}

constexpr Eigen::Index kLoopPoints = 4000;

/// Words for estimator::LawKind, in its order.
constexpr std::array kKindWords = {
    "a linear element's",
    "elastic: it follows the deformation, and what was stored comes back",
    "an impact's: it follows the deformation from a clearance on",
    "dissipative: it follows the rate of the deformation",
    "hysteretic: it follows the deformation and its past",
    "that of a stiffness which changes with time",
    "not of a kind that follows the motion there",
};
static_assert(kKindWords.size() == static_cast<std::size_t>(estimator::LawKind::external) + 1);

/// Returns a name with spaces: "cubic stiffness".
std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string spaced(estimator::EffectKind kind) {
  return spaced(std::string(name_of(kind)));
}

/// Returns the place whose kind was examined; nullptr without one, or if it needs a linear element.
const estimator::WhereEntry* of_kind(const DiagnoseOutput& o) {
  for (const estimator::WhereEntry& w : o.diagnosis.where)
    if (w.kind) return w.kind->kind == estimator::LawKind::linear ? nullptr : &w;
  return nullptr;
}

std::string loop(const estimator::KindOfLaw& kind) {
  std::vector<double> d, force;
  const Eigen::Index stride = std::max<Eigen::Index>(1, kind.d_m.size() / kLoopPoints);
  for (Eigen::Index i = 0; i < kind.d_m.size(); i += stride) {
    d.push_back(kind.d_m[i]);
    force.push_back(kind.force_n[i]);
  }
  SvgPlot plot("force beyond a linear element, strongest record", {"deformation, m"}, {"force, N"});
  plot.add({"", 0, SvgMark::thin_line, d, force});
  return plot.svg();
}

/// Plots the means of the surface along one of its sides: of all samples, and of those in the
/// middle third of the other side.
std::string means(const estimator::RestoringSurface& surface, bool over_deformation) {
  const Eigen::VectorXd& at = over_deformation ? surface.d_m : surface.v_mps;
  const Eigen::Index others = over_deformation ? surface.v_mps.size() : surface.d_m.size();
  SvgSeries all{"all samples", 1, SvgMark::dots, {}, {}};
  SvgSeries middle{
      over_deformation ? "at a low rate" : "at a small deformation", 0, SvgMark::line, {}, {}};
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    double sum = 0, count = 0, inner_sum = 0, inner_count = 0;
    for (Eigen::Index j = 0; j < others; ++j) {
      const double force = over_deformation ? surface.force_n(i, j) : surface.force_n(j, i);
      const double n = over_deformation ? surface.count(i, j) : surface.count(j, i);
      if (!std::isfinite(force)) continue;
      sum += n * force;
      count += n;
      if (j < others / 3 || j >= others - others / 3) continue;
      inner_sum += n * force;
      inner_count += n;
    }
    if (count > 0) {
      all.x.push_back(at[i]);
      all.y.push_back(sum / count);
    }
    if (inner_count > 0) {
      middle.x.push_back(at[i]);
      middle.y.push_back(inner_sum / inner_count);
    }
  }
  SvgPlot plot(over_deformation ? "mean force over deformation" : "mean force over rate",
               {over_deformation ? "deformation, m" : "rate, m/s"}, {"force, N"});
  plot.add(all);
  plot.add(middle);
  return plot.svg();
}

/// Explains each effect to people who do not know its name. In the order of EffectKind.
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
    "a mass missing in the model",
    "a mass on a separate spring",
    "rocking of the foundation",
    "bending of the whole frame",
    "another spring",
    "another damper",
    "a damping of the mode itself",
    "a sudden loss of stiffness",
    "a slow change of stiffness",
    "a floor that gives way in its plane",
    "a force that is not measured",
    "a sensor with a wrong scale",
    "a sensor mounted the wrong way round",
    "a sensor mounted askew",
    "a sensor with a delay",
    "a sensor beyond its range",
    "a sensor whose zero drifts",
    "two sensors exchanged",
};
static_assert(kPlainNames.size() == static_cast<std::size_t>(estimator::EffectKind::swapped) + 1);

/// Returns true if an effect differs from the law of its name.
bool is_approximate(const DiagnoseOutput& o) {
  const std::vector<estimator::FoundEffect>& found = o.diagnosis.effects;
  return std::any_of(found.begin(), found.end(),
                     [](const estimator::FoundEffect& f) { return f.approximate; });
}

}  // namespace

std::vector<NoiseBeyond> noise_beyond_configured(
    const estimator::Plant& plant, const std::vector<estimator::RecordSegment>& segments) {
  std::vector<NoiseBeyond> out;
  for (std::size_t a = 0; a < plant.axes.size(); ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double configured = plant.axes[a].noise_density;
    if (configured <= 0 || plant.is_force(axis) || segments.front().is_displaced(axis)) continue;
    const double read = quietest(segments, axis);
    if (read > kBeyond * configured) out.push_back({a, configured, read});
  }
  return out;
}

std::string noise_sentence(const DiagnoseOutput& o) {
  if (o.diagnosis.verdict == estimator::Verdict::adequate) return "";
  const std::vector<NoiseBeyond> beyond = noise_beyond_configured(o.plant, o.segments);
  if (beyond.empty()) return "";
  const auto ratio = [](const NoiseBeyond& n) { return n.read / n.configured; };
  const NoiseBeyond& worst = *std::max_element(
      beyond.begin(), beyond.end(),
      [&](const NoiseBeyond& a, const NoiseBeyond& b) { return ratio(a) < ratio(b); });
  return fmt::format(
      "{} reads {:.3g} times the configured noise ({:.2g} instead of {:.2g} m/s^2/sqrt(Hz), in the "
      "quietest seconds from 20 to 46 % of the sampling rate){}. If that is noise, the rest that "
      "the model leaves may be noise too: record the building at rest, or remove "
      "noise_mps2_per_rthz.",
      o.plant.axes[worst.axis].name, ratio(worst), worst.read, worst.configured,
      beyond.size() > 1
          ? fmt::format(", and {} more channels twice as much or more", beyond.size() - 1)
          : std::string());
}

std::string kind_sentence(const DiagnoseOutput& o) {
  const estimator::WhereEntry* where = of_kind(o);
  if (!where) return "";
  const auto index = static_cast<std::size_t>(where->kind->kind);
  std::string out =
      fmt::format("The force that {} needs beyond a spring and a dashpot is {}",
                  place_text(where->place, o.plant.structure, o.plant.axes), kKindWords[index]);
  if (where->kind->kind != estimator::LawKind::external)
    out += fmt::format(" (that explains {:.0f} % of it)", 100 * where->kind->share[index]);
  return out + ".";
}

std::string kind_section(const DiagnoseOutput& o) {
  const estimator::WhereEntry* where = of_kind(o);
  if (!where) return "";
  std::vector<std::vector<std::string>> rows;
  for (const estimator::LawKind kind : kReportedKinds) {
    rows.push_back(
        {spaced(law_kind_word(kind)),
         fmt::format("{:.0f} %", 100 * where->kind->share[static_cast<std::size_t>(kind)])});
  }
  const estimator::KindOfLaw& kind = *where->kind;
  return "<h2>What sort of force</h2>\n<p>" + html_text(kind_sentence(o)) +
         " The table gives the share of that force, beyond noise, that general functions of each "
         "kind explain.</p>\n" +
         html_table({"kind", "explains"}, rows) +
         html_figure({loop(kind), means(kind.surface, true), means(kind.surface, false)},
                     "The force that the place needs beyond a spring and a dashpot, without a law. "
                     "Closed loops dissipate, a single curve is elastic, a step at rate zero is "
                     "friction.");
}

std::string gap_percent(double share) {
  return fmt::format("{:.2f} %", 100 * share);
}

std::string effect_words(const DiagnoseOutput& o, const estimator::FoundEffect& f) {
  return fmt::format("{}{} at {} ({})", f.approximate ? "something like " : "",
                     spaced(f.chosen.kind),
                     place_text(f.chosen.place, o.plant.structure, o.plant.axes),
                     kPlainNames[static_cast<std::size_t>(f.chosen.kind)]);
}

std::string confidence_words(const DiagnoseOutput& o, const estimator::FoundEffect& f) {
  std::string out = fmt::format("{} (confidence {:.3g})", grade_word(grade_of(f)), f.confidence);
  if (grade_of(f) == estimator::Grade::established) return out;
  std::vector<std::string> like;
  for (const estimator::EffectKind kind : f.like) like.push_back(spaced(kind));
  if (!like.empty())
    return out + ": " + listed(like) + (like.size() > 1 ? " fit" : " fits") + " as well";
  if (f.nearest) return out + ": it is the nearest law, and leaves more than it should";
  if (f.approximate) return out + ": more than noise is left, so its form may be another";
  const std::vector<const estimator::Trial*> rivals =
      near_rivals(o.diagnosis.settings, f, estimator::kEstablished);
  if (rivals.empty()) return out + ": it was found only together with others";
  return out + fmt::format(": {} at {} is {:.0f} in log-likelihood behind",
                           spaced(rivals.front()->kind),
                           place_text(rivals.front()->place, o.plant.structure, o.plant.axes),
                           rivals.front()->cost - f.chosen.cost);
}

std::string step_words(const DiagnoseOutput& o, const estimator::FoundEffect& f) {
  return o.diagnosis.effects.size() < 2
             ? std::string()
             : fmt::format("; with it the held-out gap falls from {} to {}", gap_percent(f.before),
                           gap_percent(f.after));
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
      "The best of the known effects is {}: with it the held-out gap falls from {} to {}. It is "
      "not established, because it leaves more unexplained than it should.",
      effect_words(o, found), gap_percent(best.before), gap_percent(best.after));
}

std::string verdict_sentence(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  std::string missing;
  for (const estimator::FoundEffect& f : d.effects)
    missing += (missing.empty() ? "" : ", and ") + effect_words(o, f);
  switch (d.verdict) {
    case estimator::Verdict::adequate:
      return missing.empty() ? "Nothing is missing: the model explains the measurement as well as "
                               "the sensors' noise allows."
                             : "The model explains the measurement with " + missing + ".";
    case estimator::Verdict::explained:
      return "The model lacks " + missing +
             (is_approximate(o) ? "; with it nearly all of the gap is gone, but more than noise is "
                                  "left."
                                : "; with it the measurement is explained.");
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
      o.plant.unread.cols() == 0 ? ""
                                 : " Floors without a channel follow from the others, stories "
                                   "between measured floors share "
                                   "one factor, and laws inside such groups are not searched for.");
}

std::string damping_sentence(const DiagnoseOutput& o) {
  std::string ratios;
  for (const estimator::Effect& e : modal_damping_effects(o.diagnosis.model))
    ratios += fmt::format("{}{:.2g} % in mode {}", ratios.empty() ? "" : ", ",
                          100 * e.value("damping_ratio"), e.place.mode);
  return ratios.empty() ? ""
                        : "Dashpots between floors are not all of the damping: modes have damping "
                          "ratios in addition (" +
                              ratios + ").";
}

std::string limit_sentence(const DiagnoseOutput& o) {
  const std::vector<std::string>& not_done = o.diagnosis.not_done;
  if (not_done.empty()) return "";
  return fmt::format(
      "The limit of time ended the diagnosis. Not done, or only in part: {}. Give it more "
      "time with --limit.",
      fmt::join(not_done, "; "));
}

}  // namespace framewatch::daemon
