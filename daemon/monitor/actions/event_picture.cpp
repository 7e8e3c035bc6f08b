// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/event_picture.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/numbers.h"
#include "daemon/base/picture_files.h"
#include "daemon/base/printable.h"
#include "daemon/base/svg_converter.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/history/summary_query.h"
#include "drivers/files/descriptor.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kShown_us = 30 * kDay_us;
constexpr std::int64_t kWaitForReport_us = 5 * kSecond_us;
constexpr int kLookForReport_us = 100'000;
constexpr int kPlotWidth_px = 640, kPlotHeight_px = 280;
constexpr double kPxPerMm = 96 / 25.4;
constexpr const char* kPageEnding = ".html";

/// Returns the longest period of at most an hour with summaries; 0 without summaries.
std::int64_t shown_period_s(SummaryQuery& summaries) {
  std::int64_t out = 0;
  for (const SummaryPeriods& p : summaries.periods())
    if (p.period_s <= 3600) out = std::max(out, p.period_s);
  return out;
}

/// Returns the page of an event report. Waits for one that is not written yet.
std::optional<EmailAttachment> report_page(const std::string& folder, const std::string& segment,
                                           const Abandoned& abandoned) {
  if (!segment.ends_with(kPageEnding) ||
      !is_event_report_name(
          segment.substr(0, segment.size() - std::string_view(kPageEnding).size())))
    return std::nullopt;
  const std::int64_t until_us = steady_clock_us() + kWaitForReport_us;
  for (;;) {
    std::string problem;
    if (std::optional<std::string> page = read_text_file(folder + "/" + segment, problem))
      return EmailAttachment{segment, "text/html; charset=utf-8", *std::move(page)};
    if (steady_clock_us() >= until_us || abandoned()) return std::nullopt;
    ::usleep(kLookForReport_us);
  }
}

}  // namespace

EventSources event_sources(const Config& config) {
  return {config.history ? config.history->directory : "",
          config.event_report ? config.event_report->directory : ""};
}

std::optional<SvgPlot> parameter_plot(SummaryQuery& summaries, const event_t& event) {
  const std::vector<SummaryParameter> parameters = summaries.parameters();
  const auto parameter =
      std::find_if(parameters.begin(), parameters.end(),
                   [&](const SummaryParameter& p) { return p.name == event.place; });
  const std::int64_t period_s = shown_period_s(summaries);
  if (parameter == parameters.end() || period_s == 0) return std::nullopt;
  const std::vector<SummaryRow> rows =
      summaries.rows(parameter->id, period_s, event.time_us - kShown_us, event.time_us + 1);
  std::vector<double> medians;
  for (const SummaryRow& row : rows) medians.push_back(row.median);
  const double usual = median(medians);
  if (!std::isfinite(usual) || usual == 0) return std::nullopt;
  const auto day = [&](std::int64_t time_us) {
    return static_cast<double>(time_us - event.time_us) / static_cast<double>(kDay_us);
  };
  SvgSeries q1{"quartiles", 5, SvgMark::thin_line, {}, {}}, q3{"", 5, SvgMark::thin_line, {}, {}},
      middle{"median", 0, SvgMark::line, {}, {}};
  std::int64_t before_us = 0;
  double low = -1, high = 1;  // the noise of a steady parameter does not fill the plot
  for (const SummaryRow& row : rows) {
    const bool gap = before_us != 0 && row.start_us - before_us > 2 * period_s * kSecond_us;
    before_us = row.start_us;
    const auto add = [&](SvgSeries& s, double value) {
      const double at = day(row.start_us), y = 100 * (value / usual - 1);
      if (gap) {
        s.x.push_back(at);
        s.y.push_back(estimator::kNaN);
      }
      s.x.push_back(at);
      s.y.push_back(y);
      if (!std::isfinite(y)) return;
      low = std::min(low, y);
      high = std::max(high, y);
    };
    add(q1, row.q1);
    add(q3, row.q3);
    add(middle, row.median);
  }
  SvgPlot plot(fmt::format("{}: {:.4g} {}", parameter->name, usual, parameter->unit),
               {"days before " + utc_text(event.time_us)},
               {"change of " + parameter->name + ", %", std::floor(low), std::ceil(high)},
               kPlotWidth_px, kPlotHeight_px);
  plot.add(std::move(q1));
  plot.add(std::move(q3));
  plot.add(std::move(middle));
  if (const double since = day(event.since_us); since > day(event.time_us - kShown_us))
    plot.add({"since", 1, SvgMark::dashed, {since, since}, {std::floor(low), std::ceil(high)}});
  return plot;
}

EmailAttachment as_picture(const SvgPlot& plot, const std::string& name,
                           const std::optional<SvgConverter>& converter) {
  const std::string document = plot.document(kTwoColumns_mm);
  const EmailAttachment svg{name + ".svg", "image/svg+xml", document};
  const drivers::Descriptor memory(::memfd_create("picture", MFD_CLOEXEC));
  if (!converter || memory.get() < 0) return svg;
  const std::string path = fmt::format("/proc/self/fd/{}", memory.get());
  if (!converter->convert(document, kPxPerMm * kTwoColumns_mm, plot.height(), "png", path).empty())
    return svg;
  std::string problem;
  std::string bytes = read_text_file(path, problem).value_or("");
  return bytes.empty() ? svg : EmailAttachment{name + ".png", "image/png", std::move(bytes)};
}

std::optional<EmailAttachment> event_picture(const EventSources& sources, const event_t& event,
                                             const Abandoned& abandoned) {
  if (!sources.event_reports.empty() && !event.segment.empty())
    if (auto page = report_page(sources.event_reports, event.segment, abandoned)) return page;
  if (sources.history.empty() || event.place.empty()) return std::nullopt;
  SummaryQuery summaries;
  if (!summaries.open(sources.history).empty()) return std::nullopt;
  const std::optional<SvgPlot> plot = parameter_plot(summaries, event);
  if (!plot) return std::nullopt;
  std::string problem;
  return as_picture(*plot, printable(event.place), SvgConverter::load(problem));
}

}  // namespace framewatch::daemon
