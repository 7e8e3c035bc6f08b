// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/month_report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/base/printable.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/disk_forecast.h"
#include "daemon/monitor/history/history_days.h"
#include "daemon/monitor/history/history_losses.h"
#include "daemon/monitor/history/history_overview.h"
#include "daemon/monitor/history/loss_follower.h"
#include "daemon/monitor/history/summary_query.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kShownElements = 20, kDrawnElements = 6, kShownMonthEvents = 20;
constexpr std::int64_t kMostMonthEvents = 100'000;
constexpr int kMonthWidth_px = 640, kMonthHeight_px = 240;
constexpr double kLeastChange_pct = 2;  // half of the axis, so that noise looks like noise

std::chrono::year_month calendar(const Month& m) {
  return std::chrono::year(m.year) / std::chrono::month(static_cast<unsigned>(m.month));
}

std::int64_t first_day(const std::chrono::year_month& m) {
  return std::chrono::sys_days(m / std::chrono::day(1)).time_since_epoch().count();
}

/// An element's month.
struct ElementMonth {
  const ElementDays* element;
  double usual = estimator::kNaN;                          ///< median of all days
  double now = estimator::kNaN, before = estimator::kNaN;  ///< medians of this month, the last one
  int days = 0;                                            ///< with values
  double shown = 0;  ///< share of the windows, mean over the month

  double change() const { return now / before - 1; }
};

double median_of(const ElementDays& e, const Month& m, int& days, double& shown) {
  std::vector<double> medians;
  shown = 0;
  for (auto at = e.days.lower_bound(first_day(calendar(m)));
       at != e.days.end() && at->first * kDay_us < m.end_us(); ++at) {
    medians.push_back(at->second.median);
    shown += at->second.shown / m.days();
  }
  days = static_cast<int>(medians.size());
  return medians.empty() ? estimator::kNaN : median(std::move(medians));
}

/// Returns the elements, those that changed most first.
std::vector<ElementMonth> months_of(const std::vector<ElementDays>& elements, const Month& month) {
  std::vector<ElementMonth> out;
  for (const ElementDays& e : elements) {
    ElementMonth m{&e};
    int days_before = 0;
    double shown_before = 0;
    m.usual = e.usual();
    m.now = median_of(e, month, m.days, m.shown);
    m.before = median_of(e, month.before(), days_before, shown_before);
    out.push_back(m);
  }
  std::ranges::stable_sort(out, std::greater<>(), [](const ElementMonth& m) {
    return std::isfinite(m.change()) ? std::abs(m.change()) : -1;
  });
  return out;
}

/// Contents of the history for the month.
struct MonthData {
  std::vector<ElementDays> elements;
  HistoryLosses losses;
  FrameLabels labels;
  std::vector<event_t> events;
  std::vector<StoredAcknowledgement> acknowledgements;
  std::vector<ChannelTotals> channels;
};

bool found_in(const estimator::YearsWatch::Finding& f, const Month& m) {
  const auto found_us = static_cast<double>(kDay_us) * f.found_day;
  return found_us >= static_cast<double>(m.start_us()) &&
         found_us < static_cast<double>(m.end_us());
}

std::string coverage_sentence(const std::vector<ElementMonth>& elements, const Month& month) {
  int days = 0;
  double shown = 0;
  for (const ElementMonth& m : elements) {
    days = std::max(days, m.days);
    shown += m.shown / static_cast<double>(elements.size());
  }
  if (days == 0)
    return "No frame has a value in this month: the sensors or framewatch did not run, or the "
           "building hardly moved. Look at `framewatch status`";
  return fmt::format(
      "Coverage: values on {} of {} days; the building moved enough to show its stiffness in {} of "
      "the time",
      days, month.days(), percent(shown));
}

std::string sample_sentence(const std::vector<ChannelTotals>& channels) {
  std::int64_t received = 0, lost = 0, worst_lost = 0;
  std::string worst;
  for (const ChannelTotals& c : channels) {
    received += c.received;
    lost += c.lost;
    if (c.lost <= worst_lost) continue;
    worst_lost = c.lost;
    worst = c.name;
  }
  if (received + lost == 0) return "Sensors: no samples";
  return fmt::format("Sensors: {} samples from {} channels, {} lost{}", received, channels.size(),
                     percent(static_cast<double>(lost) / static_cast<double>(received + lost)),
                     worst.empty() ? "" : ", most of them by " + worst);
}

std::string event_sentence(const MonthData& data) {
  std::map<std::string, int> kinds;
  int alarms = 0, warnings = 0;
  for (const event_t& e : data.events) {
    const bool momentary = e.state == event_state::cleared && e.since_us == e.time_us;
    if (e.state != event_state::raised && !momentary) continue;
    alarms += e.severity >= severity::alarm;
    warnings += e.severity == severity::warning;
    ++kinds[e.kind];
  }
  const auto known = std::ranges::count_if(
      data.acknowledgements, [](const StoredAcknowledgement& a) { return !is_note(a); });
  if (kinds.empty()) return "Events: none";
  std::string list;
  for (const auto& [kind, count] : kinds)
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, kind);
  return fmt::format("Events: {} alarms and {} warnings ({}); {} acknowledgements", alarms,
                     warnings, list, known);
}

/// Returns the sentences, and sets `changed`.
std::vector<std::string> sentences_of(const MonthData& data,
                                      const std::vector<ElementMonth>& elements, const Month& month,
                                      bool& changed) {
  std::vector<std::string> out;
  std::size_t earlier = 0;
  for (const auto& f : data.losses.found) {
    if (found_in(f, month)) {
      const bool all = f.element == estimator::YearsWatch::kAllAlike;
      out.push_back("Changed: " +
                    loss_words(all ? kWholeBuilding
                                   : data.losses.elements[static_cast<std::size_t>(f.element)],
                               f, data.labels) +
                    (all ? ". It may also be a mass, or weather that is not measured" : ""));
      changed = true;
    } else {
      ++earlier;
    }
  }
  if (!changed && !elements.empty())
    out.push_back("Nothing changed this month that weather does not explain");
  if (earlier > 0) out.push_back(fmt::format("Known since earlier: {} losses", earlier));
  if (!elements.empty()) {
    std::size_t healthy = data.elements.size();
    for (std::size_t p = 0; p < data.elements.size(); ++p)
      healthy -= std::ranges::any_of(data.losses.found, [&](const auto& f) {
        return f.element == static_cast<int>(p) || f.element == estimator::YearsWatch::kAllAlike;
      });
    out.push_back(fmt::format("Healthy: {} of {} frames have no loss of 1 % or more", healthy,
                              data.elements.size()));
  }
  for (const StoredAcknowledgement& a : data.acknowledgements)
    if (a.kind == kMaintenanceKind)
      out.push_back(fmt::format("Changed on purpose on {}: {}", day_text(floor_day(a.time_us)),
                                printable(a.comment)));
  if (data.losses.wrong_sensor) out.push_back("Weather: " + wrong_sensor_sentence(data.losses));
  out.push_back(coverage_sentence(elements, month));
  out.push_back(sample_sentence(data.channels));
  out.push_back(event_sentence(data));
  return out;
}

/// Draws the days of the elements that changed most, in percent of their usual values.
SvgPlot days_plot(const std::vector<ElementMonth>& elements, const Month& month) {
  const std::int64_t first = first_day(calendar(month));
  double low = -kLeastChange_pct, high = kLeastChange_pct;
  std::vector<SvgSeries> lines;
  for (std::size_t i = 0; i < std::min(elements.size(), kDrawnElements); ++i) {
    SvgSeries line{elements[i].element->name, static_cast<int>(i), SvgMark::line, {}, {}};
    for (int d = 0; d < month.days(); ++d) {
      const auto found = elements[i].element->days.find(first + d);
      const double y = found == elements[i].element->days.end()
                           ? estimator::kNaN
                           : 100 * (found->second.median / elements[i].usual - 1);
      line.x.push_back(d + 1);
      line.y.push_back(y);
      if (!std::isfinite(y)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
    lines.push_back(std::move(line));
  }
  SvgPlot plot("stiffness by day",
               {"day of " + month.name(), 1.0, static_cast<double>(month.days())},
               {"change from the median of all days, %", std::floor(low), std::ceil(high)},
               kMonthWidth_px, kMonthHeight_px);
  for (SvgSeries& line : lines) plot.add(std::move(line));
  return plot;
}

SvgPlot month_coverage_plot(const std::vector<ElementMonth>& elements, const Month& month) {
  const std::int64_t first = first_day(calendar(month));
  SvgSeries line{"", 0, SvgMark::line, {}, {}};
  for (int d = 0; d < month.days(); ++d) {
    double sum = 0;
    for (const ElementMonth& m : elements)
      if (const auto found = m.element->days.find(first + d); found != m.element->days.end())
        sum += found->second.shown;
    line.x.push_back(d + 1);
    line.y.push_back(100 * sum / static_cast<double>(elements.size()));
  }
  SvgPlot plot("coverage", {"day of " + month.name(), 1.0, static_cast<double>(month.days())},
               {"share of the windows with values, %", 0, 100}, kMonthWidth_px, kMonthHeight_px);
  plot.add(std::move(line));
  return plot;
}

std::string elements_table(const std::vector<ElementMonth>& elements) {
  const auto number = [](double v) { return std::isfinite(v) ? fmt::format("{:.4g}", v) : "-"; };
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < std::min(elements.size(), kShownElements); ++i) {
    const ElementMonth& m = elements[i];
    rows.push_back({html_text(printable(m.element->name)), number(m.now),
                    std::isfinite(m.change()) ? fmt::format("{:+.1f} %", 100 * m.change()) : "-",
                    fmt::format("{}", m.days), percent(m.shown)});
  }
  std::string out = html_table(
      {"frame", "median, N/m", "since last month", "days with values", "coverage"}, rows);
  if (elements.size() > kShownElements)
    out += fmt::format("<p>{} other frames changed less.</p>\n", elements.size() - kShownElements);
  return out + "<p>The change since last month includes that of the weather.</p>\n";
}

std::string month_events(const MonthData& data) {
  std::multimap<std::int64_t, std::string> lines;
  for (const event_t& e : data.events)
    if (e.severity >= severity::warning || e.state == event_state::cleared)
      lines.emplace(e.time_us, event_line(e));
  for (const StoredAcknowledgement& a : data.acknowledgements)
    lines.emplace(a.time_us, acknowledgement_line(a));
  if (lines.empty()) return "<p>There were no warnings and no alarms.</p>\n";
  std::string out;
  std::size_t left = lines.size();
  for (const auto& [time_us, line] : lines)
    if (left-- <= kShownMonthEvents) out += "<li>" + html_text(printable(line)) + "</li>\n";
  return (lines.size() > kShownMonthEvents
              ? fmt::format("<p>The newest {} of {}:</p>\n", kShownMonthEvents, lines.size())
              : "") +
         "<ul>\n" + out + "</ul>\n";
}

std::string page_of(const MonthReport& report, const MonthData& data,
                    const std::vector<ElementMonth>& elements) {
  const std::string title = printable(report.building) + ", " + report.month.name();
  std::string body = "<h1>" + html_text(title) + "</h1>\n<ul>\n";
  for (const std::string& sentence : report.sentences) {
    const std::string text = html_text(printable(sentence)) + ".";
    body += sentence.starts_with("Changed") ? "<li><strong>" + text + "</strong></li>\n"
                                            : "<li>" + text + "</li>\n";
  }
  body += "</ul>\n";
  if (!elements.empty()) {
    body +=
        "<h2>Frames</h2>\n" + elements_table(elements) +
        html_figure(std::vector<std::string>{days_plot(elements, report.month).svg()},
                    "The frames that changed most. Lines break where a day has no value.") +
        html_figure(std::vector<std::string>{month_coverage_plot(elements, report.month).svg()},
                    "Share of each day's windows in which the building moved enough, mean of all "
                    "frames.");
  }
  body += "<h2>Events</h2>\n" + month_events(data);
  return html_page(title, body);
}

}  // namespace

Month Month::of(std::int64_t time_us) {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(
      std::chrono::sys_time<std::chrono::microseconds>(std::chrono::microseconds(time_us))));
  return {static_cast<int>(day.year()), static_cast<int>(static_cast<unsigned>(day.month()))};
}

Month Month::before() const {
  return month == 1 ? Month{year - 1, 12} : Month{year, month - 1};
}

std::int64_t Month::start_us() const {
  return first_day(calendar(*this)) * kDay_us;
}

std::int64_t Month::end_us() const {
  return first_day(calendar(*this) + std::chrono::months(1)) * kDay_us;
}

std::string Month::name() const {
  return fmt::format("{:04}-{:02}", year, month);
}

int Month::days() const {
  return static_cast<int>((end_us() - start_us()) / kDay_us);
}

std::optional<MonthReport> month_report(const Config& config,
                                        const std::optional<WeatherTable>& weather,
                                        const Month& month, std::int64_t now_us,
                                        std::string& problem) {
  SummaryQuery summaries;
  problem = summaries.open(config.history->directory);
  if (!problem.empty()) return std::nullopt;
  std::int64_t first_us = kEver_us;
  for (const SummaryPeriods& p : summaries.periods()) first_us = std::min(first_us, p.first_us);
  if (first_us >= month.end_us()) return std::nullopt;
  HistoryRequest request;
  request.directory = config.history->directory;
  request.config = config;
  request.to_us = month.end_us();
  request.parameters = summaries.parameters();
  MonthData data;
  data.elements = read_days(request, Quantity::stiffness, summaries);
  data.losses = find_losses(Quantity::stiffness, data.elements,
                            weather ? *weather : kept_weather(request, summaries, data.elements),
                            config.watch ? config.watch->life : estimator::LifeBudget{},
                            summaries.maintenance_days());
  data.labels = frame_labels(config.pipeline.structure);
  data.events = summaries.events(month.start_us(), month.end_us(), kMostMonthEvents);
  data.acknowledgements = summaries.acknowledgements(month.start_us(), month.end_us());
  data.channels = summaries.channels(month.start_us(), month.end_us());
  problem = summaries.problem();
  if (!problem.empty()) return std::nullopt;
  const std::vector<ElementMonth> elements = months_of(data.elements, month);
  MonthReport out;
  out.building = config.pipeline.structure.name;
  out.month = month;
  out.sentences = sentences_of(data, elements, month, out.changed);
  if (const auto growth = history_growth(*config.history, now_us)) {
    std::string disk = disk_sentence(days_until_full(*config.history, *growth), now_us);
    disk[0] = 'T';
    out.sentences.push_back(std::move(disk));
  }
  out.page = page_of(out, data, elements);
  return out;
}

}  // namespace framewatch::daemon
