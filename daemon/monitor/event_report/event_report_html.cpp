// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/event_report/event_report.h"
#include "daemon/monitor/event_report/report_words.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxBars = 40;

std::string number(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

const char* advice(EventColor color) {
  constexpr const char* kAdvice[] = {
      "Nothing needs to be done.", "Have a structural engineer read this report.",
      "Have a structural engineer inspect the building before normal use."};
  return kAdvice[static_cast<std::size_t>(color)];
}

std::string verdict_text(const EventReport& r, const Config& config, const EventVerdict& verdict,
                         const DriftReport& drifts) {
  std::string out;
  const std::vector<std::string> unheard = unheard_sentences(r.shaking);
  for (const std::string& one : unheard)
    if (one != verdict.reasons.front())
      out += "<p class=\"unheard\"><strong>" + html_text(one) + ".</strong></p>\n";
  out += "<p class=\"verdict\">" + capitalized(color_word(verdict.color)) + ": " +
         html_text(verdict.reasons.front()) + ".</p>\n";
  std::string rest;
  for (std::size_t i = 1; i < verdict.reasons.size(); ++i)
    if (std::find(unheard.begin(), unheard.end(), verdict.reasons[i]) == unheard.end())
      rest += "<li>" + html_text(verdict.reasons[i]) + "</li>\n";
  if (!rest.empty()) out += "<ul>\n" + rest + "</ul>\n";
  out += "<p>" + std::string(advice(verdict.color)) + "</p>\n" + placard_section(drifts);
  const double length =
      1e-6 * static_cast<double>(to_microseconds(r.shaking.end) - to_microseconds(r.shaking.start));
  return out + fmt::format("<h1>{}: strong motion of {}</h1>\n<p>{:.1f} s above {:g} m/s^2.</p>\n",
                           html_text(config.pipeline.structure.name),
                           sensor_time_text(to_microseconds(r.shaking.start)), length,
                           config.event_report->options.trigger_mps2);
}

std::string drift_section(const EventReport& r, const Config& config, const DriftReport& drifts) {
  const EventReportSettings& s = *config.event_report;
  SvgAxis stories{""};
  SvgSeries bars{"", 0, SvgMark::bars, {}, {}, {}};
  const bool incomplete = !r.shaking.unheard.empty();
  for (const estimator::StoryDrift& drift : drifts.drifts) {
    if (stories.categories.size() == kMaxBars) break;
    stories.categories.push_back(fmt::format("story {}", drift.story));
    bars.x.push_back(static_cast<double>(stories.categories.size()));
    bars.y.push_back(100 * drift.ratio);
    bars.error.push_back(std::isfinite(drift.std_error) ? 100 * drift.std_error : 0);
  }
  std::vector<std::vector<std::string>> rows;
  for (int story = config.pipeline.structure.stories; story >= 0; --story)
    rows.push_back(
        {story > 0 ? fmt::format("floor {}", story) : "base",
         number(peak_accel_mps2(r.shaking.peak, config.pipeline.axes, story), "{:.3f}")});
  SvgPlot plot("peak drift ratio", stories, {"% of the story height", 0}, 980, 240);
  plot.add(bars);
  plot.add_rule(100 * s.yellow_drift_ratio);
  plot.add_rule(100 * s.red_drift_ratio);
  return html_figure({plot.svg()},
                     fmt::format("Of the frames of each story the one that drifted most, with one "
                                 "standard error; dotted: yellow from {:g} %, red from {:g} %.",
                                 100 * s.yellow_drift_ratio, 100 * s.red_drift_ratio)) +
         drift_table_section(drifts, config) +
         "<h2>Force and acceleration</h2>\n<p>Peak base shear: " + (incomplete ? "at least " : "") +
         base_shear_words(r.shaking.peak, config.pipeline.structure) + ".</p>\n" +
         html_table(
             {"", incomplete ? "peak acceleration, at least, m/s^2" : "peak acceleration, m/s^2"},
             rows);
}

std::string stiffness_section(const EventReport& r, const Config& config) {
  const estimator::ParameterTable table = config.pipeline.parameters();
  SvgAxis names{""};
  SvgSeries bars{"", 1, SvgMark::bars, {}, {}, {}};
  std::vector<std::vector<std::string>> rows;
  bool any_first = false, any_last = false;
  for (int p = 0; p < table.elements(); ++p) {
    const estimator::ShakenStiffness& k = r.shaking.stiffness[static_cast<std::size_t>(p)];
    const auto mean = [](const estimator::WindowMean& m) {
      return m.count > 0 ? with_error(1e-3 * m.value, 1e-3 * m.std_error) : std::string("-");
    };
    std::string from = k.before_from == estimator::BeforeFrom::baseline         ? "baseline"
                       : k.before_from == estimator::BeforeFrom::windows_before ? "measured"
                       : k.before.count > 0                                     ? "first windows"
                                                                                : "-";
    any_first = any_first || k.before_from == estimator::BeforeFrom::first_windows;
    any_last = any_last || (k.after.count > 0 && !k.free);
    rows.push_back({html_text(table[p].name), table[p].panel < 0 ? "kN/m" : "kN/(rad*m)",
                    mean(k.before), from, mean(k.during), mean(k.after),
                    k.free ? "free vibration" : "last windows",
                    k.known() ? change_with_error(k.ratio(), k.std_error()) : "-"});
    if (!k.known() || names.categories.size() == kMaxBars) continue;
    names.categories.push_back(table[p].name);
    bars.x.push_back(static_cast<double>(names.categories.size()));
    bars.y.push_back(100 * k.ratio());
    bars.error.push_back(100 * k.std_error());
  }
  std::string out = "<h2>Stiffness before, during and after</h2>\n";
  if (!names.categories.empty()) {
    SvgPlot plot("change of every stiffness", names, {"change, %"}, 980, 240);
    plot.add(bars);
    plot.add_rule(0);
    out += html_figure({plot.svg()}, "After against before, with its standard error.");
  }
  out += html_table({"element", "unit", "before", "from", "during", "after", "from", "change, %"},
                    rows);
  if (any_first)
    out +=
        "<p>First windows: nothing was known before, so the beginning of the shaking stands for "
        "it; what was lost at once does not show.</p>\n";
  if (any_last)
    out +=
        "<p>Last windows: the building came to rest too soon, so the end of the shaking stands "
        "for it.</p>\n";
  return out;
}

std::string findings_section(const EventReport& r) {
  std::string out = "<h2>Findings</h2>\n";
  if (std::isfinite(r.shaking.gap_nrmse))
    out += fmt::format("<p>Simulation and measurement differed by {:.1f} % at most.</p>\n",
                       100 * r.shaking.gap_nrmse);
  std::vector<std::vector<std::string>> rows;
  for (const event_t& e : r.findings)
    rows.push_back({sensor_time_text(e.time_us), word(kEventStates, e.state),
                    word(kSeverities, e.severity), html_text(e.place), html_text(e.message)});
  return out + (rows.empty() ? "<p>Nothing else was announced meanwhile.</p>\n"
                             : html_table({"time", "state", "severity", "place", "what"}, rows));
}

std::string sensors_section(const EventReport& r, const Config& config) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t a = 0; a < r.axes.size(); ++a) {
    const estimator::AxisCounters& c = r.axes[a];
    rows.push_back(
        {html_text(config.pipeline.axes[a].name), number(r.shaking.peak.accel_mps2[a], "{:.3f}"),
         fmt::format("{}", c.received), fmt::format("{}", c.missing), fmt::format("{}", c.repaired),
         fmt::format("{}", c.stuck), fmt::format("{}", c.clipped), fmt::format("{}", c.rejected)});
  }
  return "<h2>Sensors meanwhile</h2>\n" +
         html_table({"channel", "peak, m/s^2", "received", "missing", "repaired", "stuck",
                     "clipped", "rejected"},
                    rows);
}

}  // namespace

std::string event_report_html(const EventReport& r, const Config& config) {
  const EventVerdict verdict = judge(r, config);
  const DriftReport drifts = drift_report(r, config);
  return html_page(
      fmt::format("{}: {}", config.pipeline.structure.name, color_word(verdict.color)),
      verdict_text(r, config, verdict, drifts) + drift_section(r, config, drifts) +
          stiffness_section(r, config) + findings_section(r) + sensors_section(r, config) +
          fmt::format("<p>framewatch " FRAMEWATCH_VERSION ", configuration <code>{}</code>. Not a "
                      "substitute for an engineer's judgement.</p>\n",
                      html_text(config.sha256)));
}

}  // namespace framewatch::daemon
