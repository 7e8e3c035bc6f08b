// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/summary_query.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/config/keys/weather_options.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"
#include "drivers/files/input_file.h"

namespace framewatch::daemon {

namespace {

/// Selects rows that `run` can have written; a damaged or foreign file may hold others.
constexpr const char* kSound =
    " WHERE period_s BETWEEN 1 AND 1000000000"
    " AND start_us BETWEEN -2000000000000000000 AND 2000000000000000000"
    " AND last_us BETWEEN -2000000000000000000 AND 2000000000000000000";

constexpr const char* kSummaryRow =
    "SELECT start_us, last_us, windows, observable, mean, std_error, min, whisker_low, q1, median,"
    " q3, whisker_high, max, outliers, boxed FROM summary JOIN period USING (period_s, start_us)"
    " WHERE parameter = ? AND period_s = ?";

constexpr const char* kEvent =
    "SELECT kind, id, time_us, state, since_us, severity, place, value, std_error, unit, message,"
    " segment FROM event";

/// Returns the rows of a statement that selects events, the newest first, in order of time.
std::vector<event_t> events_in_order(SqliteStatement& s) {
  std::vector<event_t> out;
  while (s.row()) {
    event_t e{};
    e.kind = s.text(0);
    e.id = s.integer(1);
    e.time_us = s.integer(2);
    e.state = static_cast<std::int32_t>(s.integer(3));
    e.since_us = s.integer(4);
    e.severity = static_cast<std::int32_t>(s.integer(5));
    e.place = s.text(6);
    e.value = s.number(7);
    e.std_error = s.number(8);
    e.unit = s.text(9);
    e.message = s.text(10);
    e.segment = s.text(11);
    out.push_back(std::move(e));
  }
  std::reverse(out.begin(), out.end());
  return out;
}

SummaryRow summary_row(SqliteStatement& s) {
  SummaryRow r;
  r.start_us = s.integer(0);
  r.last_us = s.integer(1);
  r.windows = s.integer(2);
  r.observable = s.integer(3);
  int column = 4;
  for (double* value : {&r.mean, &r.std_error, &r.min, &r.whisker_low, &r.q1, &r.median, &r.q3,
                        &r.whisker_high, &r.max})
    *value = s.number(column++);
  r.outliers = s.integer(column++);
  r.boxed = s.integer(column);
  return r;
}

}  // namespace

std::string SummaryQuery::open(const std::string& directory) {
  const std::string path = summary_file(directory);
  if (drivers::is_absent(path)) {
    if (raw_logs(raw_folder(directory)).empty() && raw_logs(event_folder(directory)).empty())
      return "does not exist";
    if (!file_.open(":memory:")) return file_.error();  // only raw logs
    return upgrade(file_, history_schema());
  }
  if (!file_.open_to_read(path)) return told(file_.error());
  return told(history_read_problem(file_));
}

std::string SummaryQuery::problem() const {
  return file_.failed() ? told(file_.error()) : "";
}

std::string SummaryQuery::told(const std::string& why) const {
  if (!file_.corrupt()) return why;
  return fmt::format(
      "the database is corrupt{}; `framewatch run` sets it aside and starts a new one",
      why.empty() ? "" : fmt::format(" ({})", why));
}

std::string SummaryQuery::structure() {
  SqliteStatement s = file_.prepare("SELECT structure FROM config ORDER BY first_us DESC LIMIT 1");
  return s.row() ? s.text(0) : "";
}

std::vector<SummaryParameter> SummaryQuery::parameters() {
  SqliteStatement s = file_.prepare("SELECT id, name, unit FROM parameter ORDER BY id");
  std::vector<SummaryParameter> out;
  while (s.row()) out.push_back({s.integer(0), s.text(1), s.text(2)});
  return out;
}

std::vector<SummaryPeriods> SummaryQuery::periods() {
  SqliteStatement s = file_.prepare(
      fmt::format("SELECT period_s, count(*), min(start_us), max(start_us) FROM period{}"
                  " GROUP BY period_s ORDER BY period_s",
                  kSound));
  std::vector<SummaryPeriods> out;
  while (s.row()) out.push_back({s.integer(0), s.integer(1), s.integer(2), s.integer(3)});
  return out;
}

std::vector<std::int64_t> SummaryQuery::period_lengths() {
  // Each step is a look-up in the primary key.
  SqliteStatement s =
      file_.prepare(fmt::format("SELECT min(period_s) FROM period{} AND period_s > ?", kSound));
  std::vector<std::int64_t> out;
  for (std::int64_t last = 0;; s.again()) {
    s.bind(1, last);
    if (!s.row() || s.null(0)) return out;
    out.push_back(last = s.integer(0));
  }
}

std::optional<std::int64_t> SummaryQuery::newest_us() {
  SqliteStatement s = file_.prepare(fmt::format("SELECT max(last_us) FROM period{}", kSound));
  if (!s.row() || s.null(0)) return std::nullopt;
  return s.integer(0);
}

std::vector<SummaryRow> SummaryQuery::rows(std::int64_t parameter, std::int64_t period_s,
                                           std::int64_t from_us, std::int64_t to_us) {
  std::vector<SummaryRow> out;
  visit_rows(parameter, period_s, from_us, to_us, [&](const SummaryRow& r) { out.push_back(r); });
  return out;
}

void SummaryQuery::visit_rows(std::int64_t parameter, std::int64_t period_s, std::int64_t from_us,
                              std::int64_t to_us,
                              const std::function<void(const SummaryRow&)>& take) {
  SqliteStatement s = file_.prepare(std::string(kSummaryRow) +
                                    " AND start_us >= ? AND start_us < ? ORDER BY start_us");
  s.bind(1, parameter).bind(2, period_s).bind(3, from_us).bind(4, to_us);
  while (s.row()) take(summary_row(s));
}

std::optional<SummaryRow> SummaryQuery::newest_row(std::int64_t parameter, std::int64_t period_s) {
  SqliteStatement s = file_.prepare(std::string(kSummaryRow) +
                                    " AND observable > 0 ORDER BY start_us DESC LIMIT 1");
  s.bind(1, parameter).bind(2, period_s);
  if (!s.row()) return std::nullopt;
  return summary_row(s);
}

std::optional<std::int64_t> SummaryQuery::first_us(std::int64_t period_s, std::int64_t from_us) {
  SqliteStatement s = file_.prepare(
      fmt::format("SELECT min(start_us) FROM period{} AND period_s = ? AND start_us >= ?", kSound));
  s.bind(1, period_s).bind(2, from_us);
  if (!s.row() || s.null(0)) return std::nullopt;
  return s.integer(0);
}

std::optional<std::int64_t> SummaryQuery::last_us(std::int64_t period_s, std::int64_t to_us) {
  SqliteStatement s = file_.prepare(
      fmt::format("SELECT max(start_us) FROM period{} AND period_s = ? AND start_us < ?", kSound));
  s.bind(1, period_s).bind(2, to_us);
  if (!s.row() || s.null(0)) return std::nullopt;
  return s.integer(0);
}

std::vector<WeatherSpan> SummaryQuery::weather_spans() {
  SqliteStatement table = file_.prepare("SELECT 1 FROM sqlite_master WHERE name = 'weather'");
  if (!table.row()) return {};  // an older database
  SqliteStatement s = file_.prepare(
      "SELECT name, (SELECT min(start_us) FROM weather WHERE covariate = id),"
      " (SELECT max(start_us) FROM weather WHERE covariate = id) FROM covariate ORDER BY id");
  std::vector<WeatherSpan> out;
  while (s.row())
    if (!s.null(1) && covariate_unit(s.text(0)) != nullptr)
      out.push_back({s.text(0), s.integer(1), s.integer(2)});
  return out;
}

std::vector<WeatherHour> SummaryQuery::weather(std::int64_t from_us, std::int64_t to_us) {
  std::vector<WeatherHour> out;
  for (const WeatherSpan& span : weather_spans())
    visit_weather(span.name, from_us, to_us, [&](const WeatherHour& hour) { out.push_back(hour); });
  return out;
}

void SummaryQuery::visit_weather(const std::string& covariate, std::int64_t from_us,
                                 std::int64_t to_us,
                                 const std::function<void(const WeatherHour&)>& take) {
  SqliteStatement s = file_.prepare(
      "SELECT start_us, readings, mean, min, max FROM weather WHERE covariate ="
      " (SELECT id FROM covariate WHERE name = ?) AND start_us >= ? AND start_us < ?"
      " ORDER BY start_us");
  s.bind(1, covariate).bind(2, from_us).bind(3, to_us);
  while (s.row())
    take({covariate, s.integer(0), s.integer(1), s.number(2), s.number(3), s.number(4)});
}

std::vector<ChannelTotals> SummaryQuery::channels(std::int64_t from_us, std::int64_t to_us) {
  SqliteStatement s = file_.prepare(
      "SELECT name, sum(received), sum(lost), sum(late), sum(rejected), sum(stuck), sum(clipped)"
      " FROM channel_summary JOIN channel ON channel.id = channel"
      " WHERE period_s = (SELECT min(period_s) FROM channel_summary)"
      " AND start_us >= ? AND start_us < ? GROUP BY channel ORDER BY channel");
  s.bind(1, from_us).bind(2, to_us);
  std::vector<ChannelTotals> out;
  while (s.row())
    out.push_back({s.text(0), s.integer(1), s.integer(2), s.integer(3), s.integer(4), s.integer(5),
                   s.integer(6)});
  return out;
}

std::vector<event_t> SummaryQuery::events(std::int64_t from_us, std::int64_t to_us,
                                          std::int64_t most) {
  SqliteStatement s = file_.prepare(
      fmt::format("{} WHERE time_us >= ? AND time_us < ? ORDER BY time_us DESC LIMIT ?", kEvent));
  s.bind(1, from_us).bind(2, to_us).bind(3, most);
  return events_in_order(s);
}

std::vector<event_t> SummaryQuery::raised_events(std::int64_t from_us, std::int64_t to_us,
                                                 std::int64_t most) {
  SqliteStatement s = file_.prepare(
      fmt::format("SELECT * FROM ({} WHERE state = 1 AND time_us >= ? AND time_us < ?"
                  " ORDER BY severity DESC, time_us DESC LIMIT ?) ORDER BY time_us DESC",
                  kEvent));
  s.bind(1, from_us).bind(2, to_us).bind(3, most);
  return events_in_order(s);
}

std::int64_t SummaryQuery::count_raised(std::int64_t from_us, std::int64_t to_us) {
  SqliteStatement s =
      file_.prepare("SELECT count(*) FROM event WHERE state = 1 AND time_us >= ? AND time_us < ?");
  s.bind(1, from_us).bind(2, to_us);
  return s.row() ? s.integer(0) : 0;
}

std::vector<event_t> SummaryQuery::events_of(const std::string& kind, std::int64_t most) {
  SqliteStatement s = file_.prepare(
      fmt::format("{} WHERE kind = ? AND state = 1 ORDER BY time_us DESC LIMIT ?", kEvent));
  s.bind(1, kind).bind(2, most);
  return events_in_order(s);
}

bool is_note(const StoredAcknowledgement& a) {
  return a.kind == kNoteKind || a.kind == kMaintenanceKind;
}

std::vector<std::int64_t> SummaryQuery::maintenance_days() {
  SqliteStatement s = file_.prepare(
      "SELECT time_us FROM acknowledgement WHERE kind = ? AND time_us >= 0 ORDER BY time_us");
  s.bind(1, std::string(kMaintenanceKind));
  std::vector<std::int64_t> out;
  while (s.row())
    if (const std::int64_t day = s.integer(0) / kDay_us; out.empty() || out.back() != day)
      out.push_back(day);
  return out;
}

std::vector<StoredAcknowledgement> SummaryQuery::acknowledgements(std::int64_t from_us,
                                                                  std::int64_t to_us,
                                                                  std::int64_t most) {
  SqliteStatement s = file_.prepare(
      "SELECT * FROM (SELECT id, time_us, kind, place, who, comment FROM acknowledgement"
      " WHERE time_us >= ? AND time_us < ? ORDER BY time_us DESC LIMIT ?) ORDER BY time_us");
  s.bind(1, from_us).bind(2, to_us).bind(3, most);
  std::vector<StoredAcknowledgement> out;
  while (s.row())
    out.push_back({s.integer(0), s.integer(1), s.text(2), s.text(3), s.text(4), s.text(5)});
  return out;
}

}  // namespace framewatch::daemon
