#include "daemon/monitor/history/history_command.h"

#include <cmath>
#include <map>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_overview.h"
#include "daemon/monitor/history/history_raw.h"
#include "daemon/monitor/history/history_request.h"
#include "daemon/monitor/history/summary_export.h"

namespace framewatch::daemon {
namespace {

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
  if (!summaries.problem().empty()) return;  // what was read is not all
  if (!a.out.empty()) {
    ProgressLine progress("history", false);
    progress("writing " + a.out, 0);
    if (const std::string why = write_summaries(a.out, r.period_s, found); !why.empty())
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

int fail(const std::vector<std::string>& problems) {
  for (const std::string& message : problems) fmt::print(stderr, "{}\n", printable_lines(message));
  return kBadInput;
}

}  // namespace

int history(const HistoryArguments& a) {
  std::vector<std::string> problems;
  SummaryQuery summaries;
  const auto request = read_history_request(a, summaries, problems);
  if (!request) return fail(problems);
  const bool asks = !a.out.empty() || !a.raw.empty() || a.events || !a.parameters.empty() ||
                    a.period_s != 0 || !a.from.empty() || !a.to.empty() || !a.last.empty();
  if (!asks)
    fmt::print("{}", a.json ? history_json(request->directory, summaries)
                            : printable_lines(history_overview(request->directory, summaries)));
  if (a.events) print_events(*request, summaries);
  if (!a.raw.empty()) export_raw_history(a, *request, problems);
  const bool wants_summaries = !a.out.empty() || (asks && !a.events && a.raw.empty());
  if (wants_summaries && problems.empty()) give_summaries(a, *request, summaries, problems);
  if (const std::string why = summaries.problem(); !why.empty())
    problems.push_back(fmt::format("{}: {}", summary_file(request->directory), why));
  return problems.empty() ? 0 : fail(problems);
}

}  // namespace framewatch::daemon
