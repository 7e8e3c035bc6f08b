// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_command.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/mat_file.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/history/history_days.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_losses.h"
#include "daemon/monitor/history/history_overview.h"
#include "daemon/monitor/history/history_report.h"
#include "daemon/monitor/history/loss_follower.h"
#include "daemon/monitor/history/raw_export.h"
#include "daemon/monitor/history/summary_query.h"
#include "daemon/monitor/history/weather_table.h"
#include "drivers/files/number_text.h"
#include "drivers/files/text_output.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

struct NamedSummaries {
  SummaryParameter parameter;
  std::vector<SummaryRow> rows;
};

struct Column {
  const char* name;
  double (*value)(const SummaryRow&);
};

constexpr Column kColumns[] = {
    {"windows", [](const SummaryRow& r) { return static_cast<double>(r.windows); }},
    {"observable", [](const SummaryRow& r) { return static_cast<double>(r.observable); }},
    {"mean", [](const SummaryRow& r) { return r.mean; }},
    {"std_error", [](const SummaryRow& r) { return r.std_error; }},
    {"min", [](const SummaryRow& r) { return r.min; }},
    {"whisker_low", [](const SummaryRow& r) { return r.whisker_low; }},
    {"q1", [](const SummaryRow& r) { return r.q1; }},
    {"median", [](const SummaryRow& r) { return r.median; }},
    {"q3", [](const SummaryRow& r) { return r.q3; }},
    {"whisker_high", [](const SummaryRow& r) { return r.whisker_high; }},
    {"max", [](const SummaryRow& r) { return r.max; }},
    {"outliers", [](const SummaryRow& r) { return static_cast<double>(r.outliers); }},
};

/// Writes summaries of one period as .csv or .csv.gz, one row per parameter and period
/// (docs/history.md). Returns an empty string, or the problem; then no file remains.
std::string write_csv(const std::string& path, std::int64_t period_s,
                      const std::vector<NamedSummaries>& summaries) {
  drivers::TextOutput out;
  std::string line = "start,start_s,period_s,parameter,unit";
  for (const Column& column : kColumns) line += fmt::format(",{}", column.name);
  bool good = out.open(path) && out.write(line + "\n");
  for (const NamedSummaries& s : summaries)
    for (const SummaryRow& row : s.rows) {
      line = fmt::format("{},{},{},{},{}", utc_text(row.start_us), row.start_us / 1'000'000,
                         period_s, csv_text(s.parameter.name), csv_text(s.parameter.unit));
      for (const Column& column : kColumns) {
        const double value = column.value(row);
        line += ',';
        if (std::isfinite(value)) line += drivers::format_number(value);
      }
      good = good && out.write(line + "\n");
    }
  return good && out.close() ? "" : fmt::format("{}: {}", path, out.error());
}

/// Does so as .mat, periods x parameters.
std::string write_mat(const std::string& path, std::int64_t period_s,
                      const std::vector<NamedSummaries>& summaries) {
  std::map<std::int64_t, std::size_t> row_of;
  for (const NamedSummaries& s : summaries)
    for (const SummaryRow& row : s.rows) row_of[row.start_us];
  std::vector<double> start_s;
  for (auto& [start_us, at] : row_of) {
    at = start_s.size();
    start_s.push_back(1e-6 * static_cast<double>(start_us));
  }
  const std::size_t cells = start_s.size() * summaries.size();
  if (cells * sizeof(double) > MatFile::kMaxBytes)
    return path + ": a variable of a MATLAB 5 file holds at most 2 GiB: choose a shorter time";
  std::vector<std::string> names, units;
  for (const NamedSummaries& s : summaries) {
    names.push_back(s.parameter.name);
    units.push_back(s.parameter.unit);
  }
  const std::string problem = write_mat_file(path, [&](MatFile& file) {
    bool good = file.texts("parameter", names) && file.texts("unit", units) &&
                file.matrix("period_s", {static_cast<double>(period_s)}, 1) &&
                file.matrix("start_s", start_s, 1);
    for (const Column& column : kColumns) {
      std::vector<double> values(cells, estimator::kNaN);
      for (std::size_t p = 0; p < summaries.size(); ++p)
        for (const SummaryRow& row : summaries[p].rows)
          values[row_of[row.start_us] * summaries.size() + p] = column.value(row);
      good = good && file.matrix(column.name, values, summaries.size());
    }
    return good;
  });
  return problem.empty() ? "" : fmt::format("{}: {}", path, problem);
}

constexpr std::int64_t kMaxEvents = 1'000'000;

void print_events(const HistoryRequest& r, SummaryQuery& summaries) {
  std::multimap<std::int64_t, std::string> lines;
  for (const event_t& e : summaries.events(r.from_us, r.to_us, kMaxEvents))
    lines.emplace(e.time_us, event_line(e));
  for (const StoredAcknowledgement& a : summaries.acknowledgements(r.from_us, r.to_us))
    lines.emplace(a.time_us, acknowledgement_line(a));
  for (const auto& [time_us, text] : lines) fmt::print("{}\n", printable(text));
}

std::vector<NamedSummaries> read_summaries(const HistoryRequest& r, SummaryQuery& summaries) {
  std::vector<NamedSummaries> out;
  ProgressLine progress("history", false);
  for (const SummaryParameter& p : r.parameters) {
    progress("reading " + printable(p.name),
             static_cast<double>(out.size()) / static_cast<double>(r.parameters.size()));
    out.push_back({p, summaries.rows(p.id, r.period_s, r.from_us, r.to_us)});
  }
  return out;
}

void give_summaries(const HistoryArguments& a, const HistoryRequest& r, SummaryQuery& summaries,
                    std::vector<std::string>& problems) {
  const std::vector<NamedSummaries> found = read_summaries(r, summaries);
  if (!summaries.problem().empty()) return;  // incomplete data must not be written
  if (!a.out.empty()) {
    ProgressLine progress("history", false);
    progress("writing " + a.out, 0);
    const auto write = a.out.ends_with(".mat") ? &write_mat : &write_csv;
    if (const std::string why = write(a.out, r.period_s, found); !why.empty())
      problems.push_back(why);
    return;
  }
  fmt::print("{:<21} {:<12} {:>11} {:>11} {:>11} {:>11} {:>10}  {}\n",
             fmt::format("{} s from", r.period_s), "parameter", "q1", "median", "q3", "std. error",
             "observable", "unit");
  for (const NamedSummaries& s : found)
    for (const SummaryRow& row : s.rows) {
      const auto value = [](double v) { return std::isfinite(v) ? fmt::format("{:.5g}", v) : "-"; };
      fmt::print("{:<21} {:<12} {:>11} {:>11} {:>11} {:>11} {:>9.1f}%  {}\n",
                 utc_text(row.start_us), printable(s.parameter.name), value(row.q1),
                 value(row.median), value(row.q3), value(row.std_error),
                 100.0 * static_cast<double>(row.observable) / static_cast<double>(row.windows),
                 printable(s.parameter.unit));
    }
}

/// Writes the hours of weather. A history without any is a problem.
void give_weather(const HistoryArguments& a, const HistoryRequest& r, SummaryQuery& summaries,
                  std::vector<std::string>& problems) {
  const std::vector<WeatherHour> hours = summaries.weather(r.from_us, r.to_us);
  if (!summaries.problem().empty()) {
    problems.push_back(fmt::format("{}: {}", summary_file(r.directory), summaries.problem()));
  } else if (hours.empty()) {
    problems.push_back(fmt::format("{}: no weather is kept of this time", r.directory));
  } else {
    drivers::TextOutput out;
    if (!out.open(a.weather_out) || !out.write(weather_csv(hours)) || !out.close())
      problems.push_back(fmt::format("{}: {}", a.weather_out, out.error()));
  }
}

int fail(const std::vector<std::string>& problems) {
  for (const std::string& message : problems) fmt::print(stderr, "{}\n", printable_lines(message));
  return kBadInput;
}

/// Finds losses in the daily means, shows them and writes the page. Returns the exit code: 1 when
/// there is a loss.
int show_years(const HistoryArguments& a, const HistoryRequest& r, SummaryQuery& summaries) {
  std::vector<std::string> problems;
  const std::vector<ElementDays> elements = read_days(r, Quantity::stiffness, summaries);
  const auto weather = a.weather.empty() ? std::optional(kept_weather(r, summaries, elements))
                                         : read_weather(a.weather, problems);
  if (!weather) return fail(problems);
  const estimator::LifeBudget budget =
      r.config && r.config->watch ? r.config->watch->life : estimator::LifeBudget{};
  const std::vector<std::int64_t> maintained = summaries.maintenance_days();
  const HistoryLosses losses =
      find_losses(Quantity::stiffness, elements, *weather, budget, maintained);
  const HistoryLosses damping = find_losses(
      Quantity::damping, read_days(r, Quantity::damping, summaries), *weather, budget, maintained);
  std::string page;
  if (!a.report.empty() && !elements.empty())
    page = history_page(summaries.structure(), elements, losses, damping, *weather,
                        summaries.events(r.from_us, r.to_us, kMaxEvents),
                        summaries.acknowledgements(r.from_us, r.to_us));
  if (const std::string why = summaries.problem(); !why.empty())
    return fail({fmt::format("{}: {}", summary_file(r.directory), why)});
  if (!a.report.empty() && page.empty())
    return fail(
        {fmt::format("{} was not written: the history has no hour with a value of a "
                     "frame's stiffness in this time. Choose another time with --from and "
                     "--to; `framewatch history` shows what is stored",
                     a.report)});
  if (!page.empty())
    if (const std::string why = drivers::write_text_file(a.report, page); !why.empty())
      return fail({why});
  std::string text = losses_text(losses);
  for (const std::string& sentence : damping_sentences(damping, losses)) text += sentence + "\n";
  fmt::print("{}", a.json ? losses_json(losses, damping) : printable_lines(text));
  return losses.found.empty() ? 0 : kFailed;
}

}  // namespace

int history(const HistoryArguments& a) {
  std::vector<std::string> problems;
  SummaryQuery summaries;
  const auto request = read_history_request(a, summaries, problems);
  if (!request) return fail(problems);
  if (!a.weather_out.empty()) give_weather(a, *request, summaries, problems);
  if (!problems.empty()) return fail(problems);
  if (a.losses || !a.report.empty()) return show_years(a, *request, summaries);
  const bool asks = !a.weather_out.empty() || !a.out.empty() || !a.raw.empty() || a.events ||
                    !a.parameters.empty() || a.period_s != 0 || !a.from.empty() || !a.to.empty() ||
                    !a.last.empty();
  if (!asks)
    fmt::print("{}", a.json ? history_json(request->directory, summaries)
                            : printable_lines(history_overview(request->directory, summaries)));
  if (a.events) print_events(*request, summaries);
  if (!a.raw.empty()) export_raw_history(a, *request, problems);
  const bool wants_summaries =
      !a.out.empty() || (asks && !a.events && a.raw.empty() && a.weather_out.empty());
  if (wants_summaries && problems.empty()) give_summaries(a, *request, summaries, problems);
  if (const std::string why = summaries.problem(); !why.empty())
    problems.push_back(fmt::format("{}: {}", summary_file(request->directory), why));
  return problems.empty() ? 0 : fail(problems);
}

}  // namespace framewatch::daemon
