// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_overview.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <framewatch/event_t.hpp>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_files.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxParameters = 24, kMaxChannels = 6;
constexpr std::int64_t kEventsTold = 5;

struct RawTotals {
  std::int64_t bytes = 0, logs = 0, open = 0, first_us = 0, last_us = 0;
};

RawTotals totals(const std::string& folder) {
  RawTotals out;
  for (const RawLog& log : raw_logs(folder)) {
    if (out.logs++ == 0) out.first_us = log.start_us;
    out.last_us = log.start_us;
    out.bytes += log.bytes;
    out.open += log.partial;
  }
  return out;
}

std::string raw_line(const char* what, const RawTotals& raw) {
  if (raw.logs == 0) return fmt::format("{:<12}none\n", what);
  return fmt::format("{:<12}from {}, the newest log from {}: {} {}, {}{}\n", what,
                     utc_text(raw.first_us), utc_text(raw.last_us), raw.logs,
                     raw.logs == 1 ? "log" : "logs", size_text(raw.bytes),
                     raw.open > 0 ? ", one is being written" : "");
}

std::string parameter_lines(SummaryQuery& summaries, const SummaryPeriods& period) {
  const std::vector<SummaryParameter> parameters = summaries.parameters();
  if (parameters.empty() || period.count == 0) return {};
  std::string out = fmt::format("\nSince {} ({} s):\n  {:<12} {:>12} {:>12} {:>12} {:>10}  {}\n",
                                utc_text(period.last_us), period.period_s, "", "q1", "median", "q3",
                                "observable", "unit");
  for (std::size_t p = 0; p < std::min(parameters.size(), kMaxParameters); ++p) {
    const auto rows = summaries.rows(parameters[p].id, period.period_s, period.last_us, kEver_us);
    if (rows.empty()) continue;
    const SummaryRow& r = rows.back();
    const double share = static_cast<double>(r.observable) /
                         static_cast<double>(std::max<std::int64_t>(1, r.windows));
    const auto value = [](double v) { return std::isfinite(v) ? fmt::format("{:.5g}", v) : "-"; };
    out += fmt::format("  {:<12} {:>12} {:>12} {:>12} {:>9.1f}%  {}\n", parameters[p].name,
                       value(r.q1), value(r.median), value(r.q3), 100 * share, parameters[p].unit);
  }
  if (parameters.size() > kMaxParameters)
    out += fmt::format("  and {} more: --out FILE.csv\n", parameters.size() - kMaxParameters);
  return out;
}

std::string channel_lines(SummaryQuery& summaries) {
  std::vector<ChannelTotals> channels = summaries.channels(-kEver_us, kEver_us);
  if (channels.empty()) return {};
  std::int64_t received = 0, lost = 0;
  for (const ChannelTotals& c : channels) {
    received += c.received;
    lost += c.lost;
  }
  std::string out = fmt::format("\nSamples: {} received on {} channels, {} lost\n", received,
                                channels.size(), lost);
  std::erase_if(channels, [](const ChannelTotals& c) {
    return c.lost + c.late + c.rejected + c.stuck + c.clipped == 0;
  });
  std::ranges::stable_sort(channels, std::greater<>(), &ChannelTotals::lost);
  for (std::size_t c = 0; c < std::min(channels.size(), kMaxChannels); ++c)
    out += fmt::format("  {:<12} {} lost, {} late, {} rejected, {} stuck, {} clipped\n",
                       channels[c].name, channels[c].lost, channels[c].late, channels[c].rejected,
                       channels[c].stuck, channels[c].clipped);
  if (channels.size() > kMaxChannels)
    out += fmt::format("  and {} more channels\n", channels.size() - kMaxChannels);
  return out;
}

}  // namespace

std::string size_text(std::int64_t bytes) {
  const auto b = static_cast<double>(bytes);
  return b < 1e6   ? fmt::format("{:.1f} kB", b / 1e3)
         : b < 1e9 ? fmt::format("{:.1f} MB", b / 1e6)
                   : fmt::format("{:.2f} GB", b / 1e9);
}

std::string event_line(const event_t& e) {
  return fmt::format("{}  {:<8} {:<17} {:<10} {}", utc_text(e.time_us), word(kEventStates, e.state),
                     e.kind, e.place, e.message);
}

std::string acknowledgement_line(const StoredAcknowledgement& a) {
  if (is_note(a))
    return fmt::format("{}  {:<8} {:<17} {:<10} by {}: {}", utc_text(a.time_us), "note",
                       a.kind == kNoteKind ? "" : a.kind, "", a.who, a.comment);
  return fmt::format("{}  {:<8} {:<17} {:<10} event {}, by {}{}", utc_text(a.time_us), "known",
                     a.kind, a.place, a.id, a.who, a.comment.empty() ? "" : ": " + a.comment);
}

std::string history_overview(const std::string& directory, SummaryQuery& summaries) {
  const std::string structure = summaries.structure();
  std::string out = fmt::format("{}{}{}\n", structure, structure.empty() ? "" : ": ", directory);
  out += raw_line("raw samples", totals(raw_folder(directory)));
  out += raw_line("forever", totals(event_folder(directory)));
  const std::vector<SummaryPeriods> periods = summaries.periods();
  for (const SummaryPeriods& p : periods)
    out += fmt::format("{:<12}{} periods of {} s, {} to {}\n", "summaries", p.count, p.period_s,
                       utc_text(p.first_us), utc_text(p.last_us + kSecond_us * p.period_s));
  if (periods.empty()) out += fmt::format("{:<12}none\n", "summaries");
  if (!periods.empty()) out += parameter_lines(summaries, periods.back());
  out += channel_lines(summaries);
  const std::vector<event_t> events = summaries.events(-kEver_us, kEver_us, kEventsTold);
  if (!events.empty()) out += "\nLast events (--events for all):\n";
  for (const event_t& e : events) out += "  " + event_line(e) + "\n";
  return out;
}

std::string history_json(const std::string& directory, SummaryQuery& summaries) {
  using nlohmann::ordered_json;
  const auto raw_json = [](const RawTotals& raw) {
    ordered_json out{{"logs", raw.logs}, {"bytes", raw.bytes}};
    if (raw.logs > 0) out["first_log_us"] = raw.first_us;
    if (raw.logs > 0) out["last_log_us"] = raw.last_us;
    return out;
  };
  ordered_json out{{"schema", "framewatch.history/1"},
                   {"directory", directory},
                   {"structure", summaries.structure()},
                   {"raw", raw_json(totals(raw_folder(directory)))},
                   {"kept_for_ever", raw_json(totals(event_folder(directory)))},
                   {"periods", ordered_json::array()},
                   {"parameters", ordered_json::array()},
                   {"channels", ordered_json::array()}};
  for (const SummaryPeriods& p : summaries.periods())
    out["periods"].push_back({{"period_s", p.period_s},
                              {"count", p.count},
                              {"first_us", p.first_us},
                              {"last_us", p.last_us}});
  for (const SummaryParameter& p : summaries.parameters())
    out["parameters"].push_back({{"name", p.name}, {"unit", p.unit}});
  for (const ChannelTotals& c : summaries.channels(-kEver_us, kEver_us))
    out["channels"].push_back({{"name", c.name},
                               {"received", c.received},
                               {"lost", c.lost},
                               {"late", c.late},
                               {"rejected", c.rejected},
                               {"stuck", c.stuck},
                               {"clipped", c.clipped}});
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace framewatch::daemon
