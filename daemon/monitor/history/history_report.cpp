// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/numbers.h"
#include "daemon/base/printable.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/history/history_overview.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kShownEvents = 50;
constexpr int kWidth_px = 480, kHeight_px = 220;  // two plots side by side
constexpr double kLeastSpan_pct = 2;  // of a plot of stiffness, so that noise looks like noise

/// Days on the horizontal axis, counted from the first one.
struct Span {
  std::int64_t from, to;
  double at(double day) const { return day - static_cast<double>(from); }
  SvgAxis axis() const {
    return {"days since " + day_text(from), 0, std::max(at(static_cast<double>(to)), 1.0)};
  }
};

/// Returns a day's value relative to the usual one, in percent.
double relative_pct(double value, double usual) {
  return 100 * (value / usual - 1);
}

/// Draws an element: median and quartiles of every day, and its losses. Lines break where days have
/// no value.
SvgPlot element_plot(const ElementDays& e, int element, const HistoryLosses& losses,
                     const Span& span) {
  const double usual = e.usual();
  SvgSeries q1{"quartiles", 5, SvgMark::thin_line, {}, {}}, q3{"", 5, SvgMark::thin_line, {}, {}},
      median{"median", 0, SvgMark::line, {}, {}};
  q3.told = "upper quartile";
  double low = -kLeastSpan_pct, high = kLeastSpan_pct;
  for (std::int64_t day = span.from; day <= span.to; ++day) {
    const auto found = e.days.find(day);
    const bool has = found != e.days.end();
    const auto add = [&](SvgSeries& s, double DayOfElement::*value) {
      const double y = has ? relative_pct(found->second.*value, usual) : estimator::kNaN;
      s.x.push_back(span.at(static_cast<double>(day)));
      s.y.push_back(y);
      if (!std::isfinite(y)) return;
      low = std::min(low, y);
      high = std::max(high, y);
    };
    add(q1, &DayOfElement::q1);
    add(q3, &DayOfElement::q3);
    add(median, &DayOfElement::median);
  }
  SvgPlot plot(fmt::format("{}: {:.4g} N/m", e.name, usual), span.axis(),
               {"change, %", std::floor(low), std::ceil(high)}, kWidth_px, kHeight_px);
  plot.add(std::move(q1));
  plot.add(std::move(q3));
  plot.add(std::move(median));
  for (const auto& f : losses.found)
    if (f.element == element || f.element == estimator::YearsWatch::kAllAlike)
      plot.add({"loss of " + percent(-f.ratio),
                1,
                SvgMark::dashed,
                {span.at(f.since_day), span.at(f.since_day)},
                {std::floor(low), std::ceil(high)}});
  return plot;
}

std::vector<SvgPlot> weather_plots(const WeatherTable& weather, const Span& span) {
  std::vector<SvgPlot> out;
  for (std::size_t c = 0; c < weather.covariates.size(); ++c) {
    SvgSeries line{"", 2, SvgMark::line, {}, {}};
    for (std::int64_t day = span.from; day <= span.to; ++day) {
      line.x.push_back(span.at(static_cast<double>(day)));
      line.y.push_back(weather.of(day)[c]);
    }
    SvgPlot plot(weather.covariates[c].name, span.axis(), {weather.covariates[c].name}, kWidth_px,
                 kHeight_px);
    plot.add(std::move(line));
    out.push_back(std::move(plot));
  }
  return out;
}

SvgPlot coverage_plot(const std::vector<ElementDays>& elements, const Span& span) {
  SvgSeries line{"", 0, SvgMark::line, {}, {}};
  for (std::int64_t day = span.from; day <= span.to; ++day) {
    double sum = 0;
    for (const ElementDays& e : elements)
      if (const auto found = e.days.find(day); found != e.days.end()) sum += found->second.shown;
    line.x.push_back(span.at(static_cast<double>(day)));
    line.y.push_back(100 * sum / static_cast<double>(elements.size()));
  }
  SvgPlot plot("windows with values", span.axis(), {"share of the day's windows, %", 0, 100},
               kWidth_px, kHeight_px);
  plot.add(std::move(line));
  return plot;
}

std::string figure(const std::vector<SvgPlot>& plots, const std::string& caption) {
  std::vector<std::string> drawn;
  for (const SvgPlot& plot : plots) drawn.push_back(plot.svg());
  return html_figure(drawn, caption);
}

std::string events_table(const std::vector<event_t>& events,
                         const std::vector<StoredAcknowledgement>& acknowledgements) {
  std::multimap<std::int64_t, std::string> lines;
  for (const event_t& e : events) lines.emplace(e.time_us, event_line(e));
  for (const StoredAcknowledgement& a : acknowledgements)
    lines.emplace(a.time_us, acknowledgement_line(a));
  std::string out;
  std::size_t left = lines.size();
  for (const auto& [time_us, line] : lines)
    if (left-- <= kShownEvents) out += "<li>" + html_text(printable(line)) + "</li>\n";
  return lines.empty() ? "<p>There were no events.</p>\n" : "<ul>\n" + out + "</ul>\n";
}

}  // namespace

std::string history_page(const std::string& structure, const std::vector<ElementDays>& elements,
                         const HistoryLosses& losses, const HistoryLosses& damping,
                         const WeatherTable& weather, const std::vector<event_t>& events,
                         const std::vector<StoredAcknowledgement>& acknowledgements) {
  const Span span{losses.from_day, losses.to_day};
  const std::string title = structure.empty() ? "Building" : structure;
  std::string body = "<h1>" + html_text(printable(title)) + "</h1>\n" +
                     fmt::format("<p>{} to {}, {} with values.</p>\n", day_text(span.from),
                                 day_text(span.to), days_text(losses.days));
  body += "<h2>Losses</h2>\n<p>" + html_text(losses_sentence(losses)) + ".</p>\n";
  if (!losses.maintenance_days.empty())
    body += "<p>" + html_text(maintenance_sentence(losses.maintenance_days)) + ".</p>\n";
  if (losses.wrong_sensor) body += "<p>" + html_text(wrong_sensor_sentence(losses)) + ".</p>\n";
  for (const auto& f : losses.found)
    body += "<p><strong>" + html_text(printable(loss_sentence(losses, f))) + ".</strong></p>\n";
  std::vector<std::vector<std::string>> rows = losses_rows(losses);
  for (auto& row : rows)
    for (std::string& cell : row) cell = html_text(printable(cell));
  body += html_table({"element", "median, N/m", "evidence", "most likely"}, rows);
  for (const std::string& sentence : damping_sentences(damping, losses))
    body += "<p>" + html_text(printable(sentence)) + ".</p>\n";
  body += "<h2>Stiffness day by day</h2>\n";
  std::vector<SvgPlot> plots;
  for (std::size_t p = 0; p < elements.size(); ++p)
    plots.push_back(element_plot(elements[p], static_cast<int>(p), losses, span));
  body += figure(plots,
                 "Change of each frame's stiffness from its median, by day: the median and "
                 "the quartiles of its hours. Lines break where a day has no value.");
  if (!weather.covariates.empty())
    body += "<h2>Weather</h2>\n" + figure(weather_plots(weather, span), "Daily means.");
  body += "<h2>Values</h2>\n" +
          figure({coverage_plot(elements, span)},
                 "Share of a day's windows in which the building moved enough to show its "
                 "stiffness, mean of all frames.");
  body += fmt::format("<h2>Events</h2>\n{}", events_table(events, acknowledgements));
  return html_page(title, body);
}

}  // namespace framewatch::daemon
