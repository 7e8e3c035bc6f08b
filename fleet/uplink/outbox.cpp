// SPDX-License-Identifier: MIT
#include "fleet/uplink/outbox.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"
#include "drivers/files/input_file.h"

namespace framewatch::fleet {
namespace {

using daemon::kSecond_us;
using daemon::SqliteStatement;

constexpr std::int64_t kBeforeEvent_us = 600 * kSecond_us, kAfterEvent_us = 3600 * kSecond_us;
constexpr TimeRange kEver{INT64_MIN / 4, INT64_MAX / 4};

constexpr const char* kEventColumns =
    "SELECT kind, id, time_us, state, since_us, severity, place, value, std_error, unit, message,"
    " segment FROM event";

EventKey key_of(const SqliteStatement& s) {
  return {s.text(0), s.integer(1), s.integer(2), static_cast<std::int32_t>(s.integer(3))};
}

event_t event_of(const SqliteStatement& s) {
  event_t e{};
  std::tie(e.kind, e.id, e.time_us) = std::tuple(s.text(0), s.integer(1), s.integer(2));
  e.state = static_cast<std::int32_t>(s.integer(3));
  e.since_us = s.integer(4);
  e.severity = static_cast<std::int32_t>(s.integer(5));
  std::tie(e.place, e.value, e.std_error) = std::tuple(s.text(6), s.number(7), s.number(8));
  std::tie(e.unit, e.message, e.segment) = std::tuple(s.text(9), s.text(10), s.text(11));
  return e;
}

using daemon::kDay_us;
using daemon::SqliteStatement;

constexpr std::int64_t kDays = 30;
constexpr const char* kFormat = "framewatch.inventory/1";

struct Day {
  std::int64_t events = 0;
  std::map<std::int64_t, std::int64_t> periods;  ///< count by length, s
};

using daemon::SqliteStatement;

constexpr const char* kParameters =
    "SELECT name, unit, observable, boxed, outliers, mean, std_error, min, max, q1, median, q3,"
    " whisker_low, whisker_high FROM parameter JOIN summary ON summary.parameter = parameter.id"
    " AND period_s = ? AND start_us = ? ORDER BY parameter.id";
constexpr const char* kChannels =
    "SELECT received, lost, late, repaired, rejected, stuck, clipped, noise FROM channel"
    " JOIN channel_summary ON channel_summary.channel = channel.id AND period_s = ?"
    " AND start_us = ? ORDER BY channel.id";

struct Row {
  std::array<std::int32_t, 3> counts{};
  std::array<float, 9> values{};
};

Row missing() {
  Row out;
  out.values.fill(std::numeric_limits<float>::quiet_NaN());
  return out;
}

void append(summary_t& to, const Row& row) {
  int at = 0;
  for (auto* list : {&to.observable, &to.boxed, &to.outliers})
    list->push_back(row.counts[static_cast<std::size_t>(at++)]);
  at = 0;
  for (auto* list : {&to.mean, &to.std_error, &to.min, &to.max, &to.q1, &to.median, &to.q3,
                     &to.whisker_low, &to.whisker_high})
    list->push_back(row.values[static_cast<std::size_t>(at++)]);
}

std::string config_of(daemon::SqliteFile& history, std::int64_t until_us) {
  SqliteStatement s = history.prepare(
      "SELECT sha256 FROM config WHERE first_us < ? ORDER BY first_us DESC LIMIT 1");
  s.bind(1, until_us);
  return s.row() ? s.text(0) : "";
}

void add_parameters(daemon::SqliteFile& history, const SummaryKey& key,
                    const std::optional<parameter_table_t>& table, summary_t& out) {
  std::vector<std::pair<std::string, std::string>> names;
  std::map<std::pair<std::string, std::string>, Row> rows;
  SqliteStatement s = history.prepare(kParameters);
  s.bind(1, key.period_s).bind(2, key.start_us);
  while (s.row()) {
    Row row;
    int column = 2;
    for (std::int32_t& count : row.counts) count = static_cast<std::int32_t>(s.integer(column++));
    for (float& value : row.values) value = static_cast<float>(s.number(column++));
    names.emplace_back(s.text(0), s.text(1));
    rows[names.back()] = row;
  }
  if (table && table->config_sha256 == out.config_sha256) {
    names.clear();
    for (std::size_t p = 0; p < table->name.size(); ++p)
      names.emplace_back(table->name[p], table->unit[p]);
  }
  for (const auto& name : names) {
    const auto found = rows.find(name);
    append(out, found == rows.end() ? missing() : found->second);
  }
  out.parameters = static_cast<std::int32_t>(out.mean.size());
}

void add_channels(daemon::SqliteFile& history, const SummaryKey& key, summary_t& out) {
  SqliteStatement s = history.prepare(kChannels);
  s.bind(1, key.period_s).bind(2, key.start_us);
  while (s.row()) {
    int column = 0;
    for (auto* list : {&out.received, &out.lost, &out.late, &out.repaired, &out.rejected,
                       &out.stuck, &out.clipped})
      list->push_back(s.integer(column++));
    out.noise.push_back(s.number(column));
  }
  out.channels = static_cast<std::int32_t>(out.noise.size());
}

}  // namespace

std::vector<TimeRange> united(std::vector<TimeRange> ranges) {
  std::sort(ranges.begin(), ranges.end(),
            [](const TimeRange& a, const TimeRange& b) { return a.from_us < b.from_us; });
  std::vector<TimeRange> out;
  for (const TimeRange& r : ranges) {
    if (r.to_us <= r.from_us) continue;
    if (!out.empty() && r.from_us <= out.back().to_us)
      out.back().to_us = std::max(out.back().to_us, r.to_us);
    else
      out.push_back(r);
  }
  return out;
}

/// Opens the database again if it was replaced by another file.
std::string Outbox::open() {
  const std::string path = daemon::summary_file(directory_);
  if (drivers::is_absent(path)) {
    file_.close();
    return "there is no history yet";
  }
  if (file_.is_open() && !file_.failed() && file_.in_place()) return {};
  version_ = -1;
  if (!file_.open_to_read(path)) return file_.error();
  std::string problem = daemon::version_problem(file_, daemon::history_schema());
  if (!problem.empty()) file_.close();
  return problem;
}

bool Outbox::has_news() {
  if (!open().empty()) return true;
  SqliteStatement s = file_.prepare("PRAGMA data_version");
  return !s.row() || s.integer(0) != version_;
}

std::string Outbox::collect(SentStore& sent, Waiting& out) {
  if (std::string problem = open(); !problem.empty()) return problem;
  SqliteStatement version = file_.prepare("PRAGMA data_version");
  const std::int64_t version_now = version.row() ? version.integer(0) : -1;
  SqliteStatement newest = file_.prepare("SELECT max(last_us) FROM period WHERE period_s = ?");
  newest.bind(1, summary_s_.front());
  newest_us_ = newest.row() && !newest.null(0) ? std::optional(newest.integer(0)) : std::nullopt;
  newest.again();

  Waiting found;
  collect_events(sent, found);
  if (newest_us_) {
    const bool alone = summary_s_.size() == 1;
    for (std::size_t i = alone ? 0 : 1; i < summary_s_.size(); ++i)
      collect_periods(sent, summary_s_[i], kEver, found);
    if (!alone)
      for (const TimeRange& time : wanted_minutes(sent))
        collect_periods(sent, summary_s_.front(), time, found);
  }
  if (file_.failed()) return file_.error();
  if (sent.file().failed()) return sent.error();
  std::sort(found.periods.begin(), found.periods.end(),
            [](const ClosedPeriod& a, const ClosedPeriod& b) {
              return std::pair(a.key.start_us, a.key.period_s) >
                     std::pair(b.key.start_us, b.key.period_s);
            });
  if (found.periods.size() > kMaxPeriods) found.periods.resize(kMaxPeriods);
  out = std::move(found);
  version_ = version_now;
  return {};
}

/// Compares both tables in the order of their keys.
void Outbox::collect_events(SentStore& sent, Waiting& out) {
  SqliteStatement all = file_.prepare(
      "SELECT kind, id, time_us, state FROM event"
      " ORDER BY kind, id, time_us, state");
  SqliteStatement known = sent.file().prepare(
      "SELECT kind, id, time_us, state FROM sent_event WHERE acknowledged_us >= 0"
      " ORDER BY kind, id, time_us, state");
  std::vector<EventKey> keys;
  const auto older = [](const EventKey& a, const EventKey& b) { return a.time_us < b.time_us; };
  bool more = known.row();
  while (all.row()) {
    EventKey key = key_of(all);
    while (more && key_of(known) < key) more = known.row();
    if (more && key_of(known) == key) continue;
    ++out.event_count;
    keys.push_back(std::move(key));
    if (keys.size() < 2 * kMaxEvents) continue;
    std::nth_element(keys.begin(), keys.begin() + kMaxEvents, keys.end(), older);
    keys.resize(kMaxEvents);
  }
  std::sort(keys.begin(), keys.end(), older);
  if (keys.size() > kMaxEvents) keys.resize(kMaxEvents);
  SqliteStatement row = file_.prepare(std::string(kEventColumns) +
                                      " WHERE kind = ? AND id = ? AND time_us = ? AND state = ?");
  for (const EventKey& k : keys) {
    row.bind(1, k.kind).bind(2, k.id).bind(3, k.time_us).bind(4, std::int64_t{k.state});
    if (row.row()) out.events.push_back(event_of(row));
    row.again();
  }
}

/// Finds closed periods. A period is closed when a later window is stored. If it grows afterwards,
/// because the sensors' clock was set back, it is sent again.
void Outbox::collect_periods(SentStore& sent, std::int64_t period_s, const TimeRange& time,
                             Waiting& out) {
  constexpr const char* kRange = " WHERE period_s = ? AND start_us >= ? AND start_us < ?";
  SqliteStatement all = file_.prepare(std::string("SELECT start_us, windows, open FROM period") +
                                      kRange + " ORDER BY start_us DESC");
  SqliteStatement known =
      sent.file().prepare(std::string("SELECT start_us, windows FROM sent_period") + kRange +
                          " AND acknowledged_us >= 0 ORDER BY start_us DESC");
  for (SqliteStatement* s : {&all, &known})
    s->bind(1, period_s).bind(2, time.from_us).bind(3, time.to_us);
  bool more = known.row();
  std::size_t kept = 0;
  while (all.row()) {
    const std::int64_t start_us = all.integer(0), windows = all.integer(1);
    const bool closed = all.integer(2) == 0;
    if (!closed && start_us + period_s * kSecond_us > *newest_us_) continue;
    while (more && known.integer(0) > start_us) more = known.row();
    if (more && known.integer(0) == start_us && (!closed || known.integer(1) == windows)) continue;
    ++out.period_count;
    if (kept++ < kMaxPeriods) out.periods.push_back({{period_s, start_us}, windows});
  }
}

std::vector<TimeRange> Outbox::wanted_minutes(SentStore& sent) {
  std::vector<TimeRange> out = sent.wanted_minutes();
  SqliteStatement s = file_.prepare(
      "SELECT since_us, time_us FROM event WHERE severity >= ? AND state = ?"
      " ORDER BY time_us DESC LIMIT ?");
  s.bind(1, std::int64_t{daemon::severity::warning});
  s.bind(2, std::int64_t{daemon::event_state::raised}).bind(3, SentStore::kMaxRanges);
  while (s.row()) {
    out.push_back({s.integer(0) - kBeforeEvent_us, s.integer(0) + kAfterEvent_us});
    out.push_back({s.integer(1) - kBeforeEvent_us, s.integer(1) + kAfterEvent_us});
  }
  return united(std::move(out));
}

std::string inventory(daemon::SqliteFile& history, std::int64_t newest_us, std::int64_t least_s) {
  const std::int64_t to = newest_us / kDay_us + 1, from = to - kDays;
  std::map<std::int64_t, Day> days;  // by number since 1970
  SqliteStatement events = history.prepare(
      "SELECT time_us / ?, count(*) FROM event WHERE time_us >= ? AND time_us < ? GROUP BY 1");
  events.bind(1, kDay_us).bind(2, from * kDay_us).bind(3, to * kDay_us);
  while (events.row()) days[events.integer(0)].events = events.integer(1);
  SqliteStatement periods = history.prepare(
      "SELECT start_us / ?, period_s, count(*) FROM period WHERE start_us >= ? AND start_us < ?"
      " AND period_s >= ? AND start_us + period_s * 1000000 <= ? GROUP BY 1, 2");
  periods.bind(1, kDay_us).bind(2, from * kDay_us).bind(3, to * kDay_us).bind(4, least_s);
  periods.bind(5, newest_us);
  while (periods.row()) days[periods.integer(0)].periods[periods.integer(1)] = periods.integer(2);
  if (history.failed()) return {};
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [number, day] : days) {
    nlohmann::json counts = nlohmann::json::object();
    for (const auto& [period_s, count] : day.periods) counts[fmt::format("{}", period_s)] = count;
    list.push_back({{"day", daemon::utc_text(number * kDay_us).substr(0, 10)},
                    {"from_us", number * kDay_us},
                    {"events", day.events},
                    {"periods", counts}});
  }
  return nlohmann::json{{"format", kFormat}, {"days", list}}.dump();
}

std::optional<summary_t> summary_message(daemon::SqliteFile& history, const SummaryKey& key,
                                         const std::optional<parameter_table_t>& table) {
  summary_t out{};
  out.start_us = key.start_us;
  out.period_s = static_cast<std::int32_t>(key.period_s);
  SqliteStatement period =
      history.prepare("SELECT windows FROM period WHERE period_s = ? AND start_us = ?");
  period.bind(1, key.period_s).bind(2, key.start_us);
  if (!period.row()) return std::nullopt;
  out.windows = static_cast<std::int32_t>(period.integer(0));
  period.again();
  out.config_sha256 = config_of(history, key.start_us + key.period_s * daemon::kSecond_us);
  add_parameters(history, key, table, out);
  add_channels(history, key, out);
  if (history.failed()) return std::nullopt;
  return out;
}

}  // namespace framewatch::fleet
