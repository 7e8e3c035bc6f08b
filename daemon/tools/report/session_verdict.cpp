// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/utc_time.h"
#include "daemon/base/words.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxEvents = 100, kMaxNamed = 3, kMaxInChart = 40;
constexpr double kRounding = 1e-9;

std::string since(const SessionReport& r, std::int64_t time_us) {
  const double s = session_seconds(r, time_us);
  const std::string clock = sensor_time_text(time_us);
  const bool dated = clock.find("UTC") != std::string::npos;
  if (s < 0) return "since before the session" + (dated ? ", " + clock : std::string());
  return fmt::format("since {:.1f} s after the start{}", s, dated ? " (" + clock + ")" : "");
}

/// Returns the error in percent, rounded up to a tenth so that it is never "+-0.0".
double error_percent(const ElementChange& c) {
  return std::max(0.1, std::ceil(1000 * c.std_error) / 10);
}

/// Returns "frame y2 of story 1 has lost 15.0 % (+-0.4 %) of its stiffness".
std::string what(const SessionReport& r, const ElementChange& c) {
  const std::string element = element_of(r, c.parameter);
  const bool several = element.rfind("stories", 0) == 0;
  if (!c.sized())
    return element + (several ? " are" : " is") + " changing, by an amount not known yet";
  const std::string size =
      fmt::format("{:.1f} % (+-{:.1f} %)", 100 * std::abs(c.ratio), error_percent(c));
  return element + (several ? " have " : " has ") +
         (c.ratio < 0 ? fmt::format("lost {} of {} stiffness", size, several ? "their" : "its")
                      : "become stiffer by " + size) +
         of_one_story(r.estimates.table, c);
}

std::vector<ElementChange> largest_first(std::vector<ElementChange> changes) {
  std::stable_sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) {
    return std::abs(a.ratio) > std::abs(b.ratio);
  });
  return changes;
}

std::size_t stiffnesses(const SessionReport& r) {
  return static_cast<std::size_t>(std::count_if(r.estimates.table.kind.begin(),
                                                r.estimates.table.kind.end(), is_stiffness_kind));
}

/// Says how many elements have not changed, and how many could not be judged.
std::string others_sentence(const SessionReport& r) {
  std::size_t same = 0;
  std::set<std::size_t> changed, seen;
  for (const JudgedElement& j : r.judged) {
    seen.insert(j.parameter);
    same += std::none_of(r.changes.begin(), r.changes.end(),
                         [&](const ElementChange& c) { return c.parameter == j.parameter; });
  }
  for (const ElementChange& c : r.changes) changed.insert(c.parameter);
  for (const ElementChange& c : r.recoveries) seen.insert(c.parameter);
  seen.insert(changed.begin(), changed.end());
  const std::size_t unseen = stiffnesses(r) - seen.size();
  std::string out = why_not_judged(r.estimates);
  if (same > 0 && !changed.empty())
    out += fmt::format("{} other element{} of the building {} not changed. ", same,
                       same == 1 ? "" : "s", same == 1 ? "has" : "have");
  if (unseen > 0)
    out += fmt::format(
        "{} element{} could not be judged: {} did not move enough, or not for long enough. ",
        unseen, unseen == 1 ? "" : "s", unseen == 1 ? "it" : "they");
  return out;
}

/// Says whether the sensors worked.
std::string sensors_sentence(const SessionReport& r) {
  if (!r.estimates.status) return "";
  const status_t& s = *r.estimates.status;
  std::string bad;
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    const std::int64_t lost = s.lost[i] + s.rejected[i] + s.stuck[i] + s.clipped[i];
    if (lost > 0 || s.received[i] == 0)
      bad += (bad.empty() ? "" : ", ") + s.name[i] +
             (s.received[i] == 0
                  ? " (silent)"
                  : fmt::format(" ({} of {} samples lost or bad)", lost, s.received[i] + lost));
  }
  return bad.empty() ? fmt::format("All {} sensors worked.", s.name.size())
                     : "Not every sensor worked: " + bad + ".";
}

/// Draws the change of every element with its error.
std::vector<Picture> change_chart(const SessionReport& r) {
  SvgAxis names{""};
  SvgSeries bars{"", 0, SvgMark::bars, {}, {}, {}};
  const ReportStage *before = nullptr, *after = nullptr;
  for (const ReportStage& stage : r.compared) {
    if (stage.kind != r.compared.front().kind) continue;
    (stage.after ? after : before) = &stage;
  }
  if (before == nullptr || after == nullptr) return {};
  std::vector<std::size_t> shown;
  for (const JudgedElement& j : r.judged) shown.push_back(j.parameter);
  for (const ElementChange& c : r.changes) shown.push_back(c.parameter);
  std::sort(shown.begin(), shown.end());
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  for (const std::size_t p : shown) {
    if (names.categories.size() == kMaxInChart) break;
    const ParameterSummary a = summarise(r.estimates, p, before->whole),
                           b = summarise(r.estimates, p, after->whole);
    if (!std::isfinite(a.mean) || !std::isfinite(b.mean)) continue;
    names.categories.push_back(place_of(r, p));
    bars.x.push_back(static_cast<double>(names.categories.size()));
    const auto change = std::find_if(r.changes.begin(), r.changes.end(),
                                     [&](const auto& c) { return c.parameter == p && c.sized(); });
    const double windows = r.estimates.table.window_rows / r.estimates.table.hop_rows;
    const auto error = [&](const ParameterSummary& s, const WindowRange& w) {
      return s.std_error / std::sqrt(std::max(1.0, static_cast<double>(w.size()) / windows));
    };
    bars.y.push_back(100 * (change == r.changes.end() ? b.mean / a.mean - 1 : change->ratio));
    bars.error.push_back(100 *
                         (change == r.changes.end()
                              ? std::hypot(error(a, before->whole), error(b, after->whole)) / a.mean
                              : change->std_error));
  }
  if (names.categories.empty()) return {};
  SvgPlot plot("change of every stiffness", names, {"change, %"}, 980, 240);
  plot.add(bars);
  plot.add_rule(0);
  return {{"change", std::move(plot)}};
}

/// Lists the recoveries. Frames soften while they move strongly; recovering is not a change of the
/// building.
std::string recovery_sentence(const SessionReport& r) {
  const std::vector<ElementChange> recoveries = largest_first(r.recoveries);
  std::string out = "While the motion died away ";
  for (std::size_t i = 0; i < std::min(recoveries.size(), kMaxNamed); ++i)
    out += fmt::format("{}{}{} by {:.1f} % (+-{:.1f} %)", i == 0 ? "" : ", ",
                       element_of(r, recoveries[i].parameter), i == 0 ? " grew stiffer again" : "",
                       100 * recoveries[i].ratio, error_percent(recoveries[i]));
  if (recoveries.size() > kMaxNamed)
    out += fmt::format(", and {} more", recoveries.size() - kMaxNamed);
  return out +
         ": frames soften while they move strongly and recover, which is not a change of the "
         "building.";
}

/// Draws the stiffness of a changed element over time, with its means as lines.
Picture change_history(const SessionReport& r, const ElementChange& c) {
  const auto [factor, unit] = r.units.of(r.estimates.table.kind[c.parameter]);
  std::vector<double> t, v, before, after;
  for (std::size_t w = 0; w < r.estimates.windows(); ++w) {
    t.push_back(session_seconds(r, r.estimates.end_us[w]));
    v.push_back(factor * r.estimates.value[c.parameter][w]);
  }
  const double at = session_seconds(r, c.since_us);
  SvgAxis y{"stiffness, " + unit};
  const double low = factor * std::min(c.before.value, c.after.value),
               high = factor * std::max(c.before.value, c.after.value);
  y.low = low - 0.6 * (high - low);
  y.high = high + 0.6 * (high - low);
  SvgPlot plot(element_of(r, c.parameter), {"time, s"}, y, 980, 220);
  plot.add(SvgSeries{"each window, at its end", 5, SvgMark::thin_line, t, v});
  plot.add(SvgSeries{"before",
                     0,
                     SvgMark::line,
                     {t.front(), at},
                     {factor * c.before.value, factor * c.before.value}});
  plot.add(SvgSeries{
      "after", 1, SvgMark::line, {at, t.back()}, {factor * c.after.value, factor * c.after.value}});
  return {"change-" + r.estimates.table.name[c.parameter], std::move(plot)};
}

/// Returns the largest changes that have windows before and after them.
std::vector<ElementChange> drawn_changes(const SessionReport& r) {
  std::vector<ElementChange> out = largest_first(r.changes);
  out.resize(std::min(out.size(), kMaxNamed));
  std::erase_if(out, [](const ElementChange& c) { return !c.measured(); });
  return out;
}

std::string change_table(const SessionReport& r) {
  std::vector<std::vector<std::string>> rows;
  for (const ElementChange& c : r.changes) {
    const auto [factor, unit] = r.units.of(r.estimates.table.kind[c.parameter]);
    const auto mean = [factor = factor](const estimator::WindowMean& m) {
      return m.count > 0 ? with_error(factor * m.value, factor * m.std_error) : std::string("-");
    };
    rows.push_back(
        {html_text(element_of(r, c.parameter)), html_text(r.estimates.table.name[c.parameter]),
         unit, mean(c.before), mean(c.after),
         c.sized() ? change_with_error(c.ratio, 0.01 * error_percent(c)) : "not known yet",
         fmt::format("{:.1f}", session_seconds(r, c.since_us))});
  }
  if (rows.empty()) return "";
  const bool announced = std::any_of(r.changes.begin(), r.changes.end(),
                                     [](const ElementChange& c) { return c.announced; });
  return html_table({"element", "parameter", "unit", "before", "after", "change, %", "since, s"},
                    rows) +
         (announced ? "<p>The change is the announced one, against the baseline and at equal "
                      "amplitude; before and after are means of this session's windows.</p>\n"
                    : "");
}

/// Returns the least loss of one story of a frame that would have shown in every judged frame.
double shows(const SessionReport& r) {
  double most = 0;
  for (const JudgedElement& j : r.judged)
    if (r.estimates.table.kind[j.parameter] ==
        static_cast<int>(estimator::ParameterKind::frame_stiffness))
      most = std::max(most, j.shows);
  return most > 0 ? most : estimator::WatchOptions{}.least_change_k;
}

/// Returns an alarm, other than a change of a stiffness, that is raised at the end; nullptr without
/// one.
const event_t* open_alarm(const SessionReport& r) {
  std::map<std::int64_t, const event_t*> last;
  for (const event_t& e : r.estimates.events) last[e.id] = &e;
  for (const auto& [id, e] : last)
    if (e->state != event_state::cleared && e->severity == severity::alarm &&
        e->kind != "stiffness_change")
      return e;
  return nullptr;
}

/// Says why [watch] could not announce a change during the measurement; "" when it could.
std::string why_no_watch(const SessionReport& r) {
  if (!r.estimates.watch)
    return "No change was announced during the measurement, because [watch] is not configured.";
  for (std::size_t p = 0; p < r.estimates.parameters(); ++p)
    if (r.estimates.compared(p)) return "";
  return "No change was announced during the measurement, because [watch] had no baseline yet.";
}

}  // namespace

std::string verdict_sentence(const SessionReport& r) {
  const std::vector<ElementChange> changes = largest_first(r.changes);
  if (const event_t* all = common_change(r.estimates); changes.empty() && all != nullptr)
    return with_capital(common_change_sentence(all->value / 100, all->std_error / 100)) + ".";
  if (const event_t* open = open_alarm(r); changes.empty() && open != nullptr)
    return fmt::format("An alarm is open at the end: {}.", open->message);
  if (changes.empty() && r.judged.empty() && !r.recoveries.empty())
    return "It is unknown whether the building has changed: after its strong motion there was "
           "only weaker motion, in which frames are stiffer.";
  if (changes.empty() && r.judged.empty())
    return "It is unknown whether the building has changed: it did not move enough, or not for "
           "long enough.";
  if (changes.empty())
    return fmt::format(
        "The building has not changed: {} of its {} frames and floor panels kept "
        "their stiffness, and the loss of {:.0f} % of a frame would have shown.",
        r.judged.size(), stiffnesses(r), std::ceil(100 * shows(r) - kRounding));
  std::string out;
  for (std::size_t i = 0; i < std::min(changes.size(), kMaxNamed); ++i)
    out += (i == 0 ? "" : "; ") + what(r, changes[i]) + ", " + since(r, changes[i].since_us);
  if (changes.size() > kMaxNamed)
    out += fmt::format("; and {} more changes", changes.size() - kMaxNamed);
  return with_capital(out) + ".";
}

std::string bending_sentence(const SessionReport& r) {
  constexpr int kFits = 1;  // model_fit_t::word
  const ModelFitTold* fit = r.config && !r.compared.empty()
                                ? model_fit_at_end(r.estimates, r.compared.back().whole)
                                : nullptr;
  if (fit == nullptr) return "";
  const estimator::PipelineConfig& c = r.config->pipeline;
  const estimator::ParameterTable table = c.parameters();
  std::vector<std::string> fits, does_not;
  for (const estimator::Direction d : {estimator::Direction::x, estimator::Direction::y}) {
    if (c.bending_nmprad[d == estimator::Direction::x ? 0 : 1] > 0) continue;
    if (!bends_as_a_whole(c.structure, d)) continue;
    int worst = 0;
    for (int p = 0; p < table.elements() && p < static_cast<int>(fit->word.size()); ++p)
      if (table[p].kind == estimator::ParameterKind::frame_stiffness && table[p].direction == d)
        worst = std::max(worst, fit->word[static_cast<std::size_t>(p)]);
    if (worst > 0) (worst > kFits ? does_not : fits).push_back(letter(d));
  }
  std::string out;
  if (!does_not.empty())
    out = fmt::format(
        "Along {} the model does not fit. Frames this tall bend as a whole: set kr{}_nmprad in "
        "[structure.design] and evaluate this record again.",
        fmt::join(does_not, " and "), fmt::join(does_not, "_nmprad and kr"));
  if (!fits.empty())
    out +=
        fmt::format("{}Frames this tall may bend as a whole; along {} the model fits without it.",
                    out.empty() ? "" : " ", fmt::join(fits, " and "));
  return out;
}

std::string verdict_section(const SessionReport& r) {
  std::string out = "<p class=\"verdict\">" + html_text(verdict_sentence(r)) + "</p>\n";
  if (!r.recoveries.empty()) out += html_paragraph(recovery_sentence(r));
  out += html_paragraph(bending_sentence(r));
  if (r.estimates.watch) out += html_paragraph(why_no_watch(r));
  out += html_paragraph(others_sentence(r) + sensors_sentence(r));
  if (const std::vector<Picture> chart = change_chart(r); !chart.empty())
    out += html_figure(chart,
                       "Stiffness after the change against before it, with its standard error.");
  for (const ElementChange& c : drawn_changes(r))
    out += html_figure(std::vector<Picture>{change_history(r, c)},
                       html_text(with_capital(what(r, c)) + " " + since(r, c.since_us) + " (" +
                                 r.estimates.table.name[c.parameter] + ")."));
  return out + change_table(r);
}

std::vector<Picture> change_pictures(const SessionReport& r) {
  std::vector<Picture> out = change_chart(r);
  for (const ElementChange& c : drawn_changes(r)) out.push_back(change_history(r, c));
  return out;
}

std::string events_section(const SessionReport& r) {
  std::vector<std::vector<std::string>> rows;
  for (const event_t& e : r.estimates.events) {
    if (rows.size() == kMaxEvents) break;
    rows.push_back(
        {fmt::format("{:.2f}", session_seconds(r, e.time_us)), word(kEventStates, e.state),
         word(kSeverities, e.severity),
         html_text(e.kind == "stiffness_change" ? place_words(e.place, r.labels) : e.place),
         html_text(e.message)});
  }
  if (rows.empty()) {
    std::string why = why_no_watch(r);
    if (why.empty())
      why = "No event was announced during the measurement.";
    else if (!r.changes.empty())
      why += " This report found the changes above afterward, from all windows of the session.";
    return "<h2>Events</h2>\n" + html_paragraph(why);
  }
  return "<h2>Events</h2>\n<p>As they were announced during the measurement.</p>\n" +
         html_table({"time, s", "state", "severity", "place", "what"}, rows) +
         (r.estimates.events.size() > kMaxEvents
              ? fmt::format("<p>{} more.</p>\n", r.estimates.events.size() - kMaxEvents)
              : std::string());
}

}  // namespace framewatch::daemon
