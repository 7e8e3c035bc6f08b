// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/words.h"
#include "daemon/tools/diagnosis/evidence_section.h"
#include "daemon/tools/diagnosis/next_measurement.h"
#include "daemon/tools/diagnosis/search_section.h"
#include "daemon/tools/diagnosis/where_map.h"
#include "estimator/diagnose/trials/catalogue_form.h"
#include "estimator/diagnose/verdict/evidence.h"
#include "estimator/diagnose/verdict/verdict.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kRanked = 6;

std::string place(const DiagnoseOutput& o, const estimator::EffectPlace& p) {
  return html_text(place_text(p, o.plant.structure, o.plant.axes));
}

std::string use(const DiagnoseOutput& o, std::size_t r) {
  return r < o.holdout_from ? "train" : "held out";
}

std::string gap_section(const DiagnoseOutput& o) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> plots;
  for (std::size_t r = 0; r < o.diagnosis.before.size() && r < o.diagnosis.after.size(); ++r) {
    const estimator::Gap& before = o.diagnosis.before[r];
    const estimator::Gap& after = o.diagnosis.after[r];
    rows.push_back({html_text(o.records[r].path) + " (" + use(o, r) + ")",
                    gap_percent(before.overall), gap_percent(after.overall),
                    gap_percent(before.overall_floor)});
    SvgAxis names{""};
    SvgSeries b{"before", 1, SvgMark::rings, {}, {}}, a{"after", 0, SvgMark::dots, {}, {}},
        n{"noise floor", 6, SvgMark::bars, {}, {}};
    for (std::size_t c = 0; c < o.plant.axes.size(); ++c) {
      if (o.plant.is_input(static_cast<Eigen::Index>(c)) && !o.plant.prescribed) continue;
      names.categories.push_back(o.plant.axes[c].name);
      const auto x = static_cast<double>(names.categories.size());
      const auto at = static_cast<Eigen::Index>(c);
      for (SvgSeries* s : {&b, &a, &n}) s->x.push_back(x);
      b.y.push_back(100 * before.axis[at]);
      a.y.push_back(100 * after.axis[at]);
      n.y.push_back(100 * before.floor[at]);
    }
    if (r + 1 < o.diagnosis.before.size() && r < o.holdout_from) continue;
    SvgPlot plot("by channel: " + o.records[r].path, names, {"gap, % of the channel's motion"});
    plot.add(n);
    plot.add(b);
    if (!o.diagnosis.effects.empty()) plot.add(a);
    plot.describe(fmt::format("The widest gap before is {} of channel {}.",
                              gap_percent(before.worst),
                              o.plant.axes[static_cast<std::size_t>(before.worst_axis)].name));
    if (names.categories.size() > 1) plots.push_back(plot.svg());
  }
  const std::string fitted = o.diagnosis.after_of_all
                                 ? "The training records do not determine the effects: the gap "
                                   "after is of a model fitted to all records."
                                 : "Both models were fitted to the training records alone.";
  return "<h2>Gap between simulation and measurement</h2>\n"
         "<p>Free run from the measured " +
         driver_words(o) + " alone, as a share of " + html_text(denominator_words(o)) + ". " +
         fitted + "</p>\n" + html_table({"record", "before", "after", "noise floor"}, rows) +
         gap_parts_section(o) +
         (plots.empty() ? ""
                        : html_figure(plots,
                                      "The gap of every channel, with the floor that the "
                                      "sensors' noise alone gives."));
}

std::string history_section(const DiagnoseOutput& o) {
  std::vector<std::string> plots;
  for (std::size_t r = 0; r < o.diagnosis.before.size() && r < o.diagnosis.after.size(); ++r) {
    const estimator::RecordSegment& s = o.segments[r];
    const int axis = o.diagnosis.before[r].worst_axis;
    const Eigen::VectorXd measured = signal_of(s.spectrum.row(axis).transpose(), s, 1);
    const auto simulated = [&](const estimator::Gap& gap) {
      return Eigen::VectorXd(measured - signal_of(gap.difference.row(axis).transpose(), s, 1));
    };
    const Eigen::VectorXd before = simulated(o.diagnosis.before[r]),
                          after = simulated(o.diagnosis.after[r]);
    Eigen::Index peak = 0;
    measured.cwiseAbs().maxCoeff(&peak);
    const auto span = static_cast<Eigen::Index>(4 * s.rate_hz);
    const Eigen::Index from =
        std::max<Eigen::Index>(0, std::min(peak - span / 2, measured.size() - span));
    const Eigen::Index to = std::min(measured.size(), from + span);
    std::vector<double> t, m, b, a;
    for (Eigen::Index i = from; i < to; ++i) {
      t.push_back(static_cast<double>(i) / s.rate_hz);
      m.push_back(measured[i]);
      b.push_back(before[i]);
      a.push_back(after[i]);
    }
    SvgPlot plot(use(o, r) + ": channel " + o.plant.axes[static_cast<std::size_t>(axis)].name,
                 {"time, s"}, {"acceleration in the band, m/s^2"});
    plot.add({"measured", 6, SvgMark::line, t, m});
    plot.add({"simulated before", 1, SvgMark::dashed, t, b});
    plot.add({"simulated after", 0, SvgMark::thin_line, t, a});
    plots.push_back(plot.svg());
  }
  return "<h2>Measured and simulated</h2>\n" +
         html_figure(plots, "The channel with the widest gap, around the strongest motion.");
}

/// Returns the time span with nine tenths of the signal that a place needs.
std::string when(const DiagnoseOutput& o, const estimator::WhereEntry& w) {
  if (!(w.to_s > w.from_s)) return "";
  return fmt::format("{:.1f} to {:.1f} s of {}", w.from_s, w.to_s,
                     html_text(o.records[w.record].path));
}

std::string band(const estimator::WhereEntry& w) {
  return w.high_hz > w.low_hz ? fmt::format("{:.2f} to {:.2f} Hz", w.low_hz, w.high_hz) : "";
}

std::string peak(const estimator::WhereEntry& w) {
  const char* unit = w.place.kind == estimator::PlaceKind::channel ? "m/s^2" : "N";
  return w.peak > 0 ? fmt::format("{:.3g} {}", w.peak, unit) : "";
}

std::string where_section(const DiagnoseOutput& o) {
  if (o.diagnosis.verdict == estimator::Verdict::adequate)
    return fmt::format(
        "<h2>Where</h2>\n<p>Nowhere: the linear model leaves {:.3g} times the sensors' "
        "noise.</p>\n",
        o.diagnosis.ratio_before);
  std::vector<std::vector<std::string>> rows;
  for (const estimator::WhereEntry& w : o.diagnosis.where)
    rows.push_back(
        {place(o, w.place), fmt::format("{:.3f}", w.ratio), when(o, w), band(w), peak(w)});
  return fmt::format(
             "<h2>Where</h2>\n<p>Each place in turn may have an arbitrary force. At the right "
             "place the rest of a linear building then fits: the rest that is not explained falls "
             "from {:.3g} times the sensors' noise to 1.</p>\n",
             o.diagnosis.ratio_before) +
         html_figure(
             where_map(o.plant.structure, o.plant.axes, o.diagnosis.map, o.diagnosis.ratio_before),
             "Plans of the stories. The stronger a frame, panel, mass or sensor is drawn, the less "
             "an arbitrary force there leaves unexplained. The three best are numbered.") +
         html_table({"place", "left, times noise", "when", "frequencies", "largest"}, rows);
}

/// Says why a candidate lost, for estimator::TrialOutcome in its order.
constexpr std::array kWhyItLost = {
    "leaves more unexplained",
    "others at its place explain more when the measured motion drives the law",
    "its free run diverges",
    "its fitted parameters do not give the law of this name",
};

/// Returns a table of the best trials. chosen: the one that they lost against; null without one.
std::string ranking(const DiagnoseOutput& o, const std::vector<estimator::Trial>& trials,
                    const estimator::Trial* chosen) {
  std::vector<std::vector<std::string>> rows;
  const double best = chosen ? chosen->cost : trials.front().cost;
  const auto add = [&](const estimator::Trial& t, const std::string& fate) {
    std::string name(name_of(t.kind)), where = place(o, t.place);
    if (t.second) {
      name += " and " + std::string(name_of(t.second->first));
      where += " and " + place(o, t.second->second);
    }
    rows.push_back(
        {html_text(name), where, or_dash(misfit_ratio(o.plant, o.segments, t), "{:.3g}"),
         t.outcome == estimator::TrialOutcome::fitted ? fmt::format("{:.0f}", t.cost - best) : "-",
         fate});
  };
  if (chosen) add(*chosen, "named");
  std::size_t shown = 0;
  for (const estimator::Trial& t : trials) {
    if (shown == kRanked) break;
    add(t, kWhyItLost[static_cast<std::size_t>(t.outcome)]);
    ++shown;
  }
  return html_table({"candidate", "place", "leaves, times noise",
                     "log-likelihood below the named one", "why it lost"},
                    rows) +
         (trials.size() > shown
              ? fmt::format("<p>{} more are in diagnosis.json.</p>\n", trials.size() - shown)
              : "");
}

std::string effects_section(const DiagnoseOutput& o) {
  std::string out;
  for (const estimator::FoundEffect& f : o.diagnosis.effects) {
    const estimator::Effect effect = catalogue_effect(o.plant, o.segments, f, o.diagnosis.model);
    const estimator::EffectDescription& d = describe(effect.kind);
    out += "<h2>" + html_text(std::string(d.name)) + ", " + place(o, effect.place) + "</h2>\n<p>" +
           html_text(std::string(d.equation)) + "</p>\n";
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < d.parameters.size(); ++i)
      rows.push_back(
          {html_text(std::string(d.parameters[i].meaning)), fmt::format("{:.5g}", effect.values[i]),
           i < f.std_error.size() && f.std_error[i] > 0 ? fmt::format("{:.2g}", f.std_error[i])
                                                        : "",
           html_text(std::string(d.parameters[i].unit))});
    if (!rows.empty()) out += html_table({"parameter", "value", "standard error", "unit"}, rows);
    out += html_paragraph(with_capital(confidence_words(o, f)) + ".");
    if (f.alternatives.empty()) continue;
    const bool alone = !std::isnan(f.chosen.fraction);  // not found together with others
    out += "<h3>Rivals</h3>\n" + ranking(o, f.alternatives, alone ? &f.chosen : nullptr);
  }
  if (!o.diagnosis.rejected.empty())
    out +=
        "<h2>Rejected effects</h2>\n<p>No effect that fits its name explains 97 % of what an "
        "arbitrary force at the best place explains without worsening a record.</p>\n" +
        ranking(o, o.diagnosis.rejected, nullptr);
  return out;
}

std::string provenance(const DiagnoseOutput& o) {
  std::vector<std::vector<std::string>> rows{
      {html_text(o.config.path), "configuration", o.config.sha256}};
  for (std::size_t r = 0; r < o.records.size(); ++r)
    rows.push_back({html_text(o.records[r].path), use(o, r), o.records[r].sha256});
  return "<h2>Provenance</h2>\n" + html_table({"file", "use", "SHA-256"}, rows) +
         "<p>framewatch " FRAMEWATCH_VERSION ", diagnose</p>\n";
}

}  // namespace

std::string diagnosis_report(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  std::string body = "<p class=\"verdict\">" + html_text(verdict_sentence(o)) + "</p>\n" +
                     html_paragraph(gap_sentence(o));
  body += html_paragraph(limit_sentence(o)) + html_paragraph(damping_sentence(o)) +
          html_paragraph(noise_sentence(o));
  std::string items;
  for (const estimator::FoundEffect& f : d.effects)
    items += "<li>" +
             html_text(with_capital(effect_words(o, f)) + ": " + confidence_words(o, f) +
                       step_words(o, f)) +
             ".</li>\n";
  std::vector<std::string> more{leading_sentence(o)};
  if (d.effects.empty()) more.push_back(kind_sentence(o));
  for (const std::string& text : more)
    if (!text.empty()) items += "<li>" + html_text(text) + "</li>\n";
  if (!items.empty()) body += "<ul>\n" + items + "</ul>\n";
  body += html_paragraph(d.reason);
  if (const std::string next = next_measurement(o); !next.empty())
    body += "<p><strong>Measure next.</strong> " + html_text(next) + "</p>\n";
  const std::string title = "Diagnosis of " + o.plant.structure.name;
  body += "<h1>" + html_text(title) + "</h1>\n";
  body += force_section(o) + gap_section(o) + residual_section(o) + effects_section(o) +
          where_section(o) + kind_section(o) + search_section(o) + history_section(o);
  return html_page(title, body + provenance(o));
}

}  // namespace framewatch::daemon
