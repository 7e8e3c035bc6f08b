// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/summary_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "daemon/base/clocks.h"
#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

std::int64_t start_of(std::int64_t time_us, std::int64_t period_s) {
  return floor_to(time_us, period_s * kSecond_us);
}

/// Binds the columns of a summary from `observable` on, starting at index `at`.
void bind_summary(SqliteStatement& s, int at, std::int64_t observable, double mean,
                  double std_error, double min, double max, const std::vector<double>& box) {
  const estimator::BoxplotStatistics b = boxplot_of(box);
  s.bind(at, observable).bind(at + 1, mean).bind(at + 2, std_error).bind(at + 3, min);
  s.bind(at + 4, b.whisker_low).bind(at + 5, b.q1).bind(at + 6, b.median).bind(at + 7, b.q3);
  s.bind(at + 8, b.whisker_high).bind(at + 9, max).bind(at + 10, std::int64_t{b.outliers});
  s.bind(at + 11, static_cast<std::int64_t>(box.size()));
}

constexpr const char* kPutSummary =
    "INSERT OR REPLACE INTO summary (parameter, period_s, start_us, observable, mean, std_error,"
    " min, whisker_low, q1, median, q3, whisker_high, max, outliers, boxed)"
    " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";

}  // namespace

/// Takes the lock unless this program has it; a moved directory does not count. Returns an empty
/// string, or the reason of a failure.
std::string SummaryStore::lock() {
  struct stat named {
  }, locked{};
  if (lock_.get() >= 0 && ::stat(settings_.directory.c_str(), &named) == 0 &&
      ::fstat(lock_.get(), &locked) == 0 && named.st_ino == locked.st_ino &&
      named.st_dev == locked.st_dev)
    return {};
  lock_.reset(::open(settings_.directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock_.get() >= 0 && ::flock(lock_.get(), LOCK_EX | LOCK_NB) == 0) return {};
  const int why = errno;
  lock_.reset(-1);
  return why == EWOULDBLOCK ? "another program writes this history" : std::strerror(why);
}

std::string SummaryStore::open() {
  std::error_code none;
  std::filesystem::create_directories(settings_.directory, none);
  if (std::string problem = lock(); !problem.empty()) return problem;
  return upgraded(file_.open(summary_file(settings_.directory)));
}

std::string SummaryStore::open_new(const std::string& path) {
  return upgraded(file_.open_new(path));
}

std::string SummaryStore::upgraded(bool opened) {
  if (!opened) return file_.error();
  std::string problem = upgrade(file_, history_schema());
  if (!problem.empty()) file_.close();
  return problem;
}

std::vector<std::pair<std::int64_t, std::int64_t>> SummaryStore::open_periods() {
  SqliteStatement all = file_.prepare(
      "SELECT start_us, last_us FROM period WHERE period_s = ? AND open = 1 ORDER BY start_us");
  all.bind(1, settings_.summary_s.front());
  std::vector<std::pair<std::int64_t, std::int64_t>> out;
  while (all.row()) out.emplace_back(all.integer(0), all.integer(1));
  return out;
}

std::string SummaryStore::add(const SummaryBatch& batch) {
  const std::int64_t repeated = repeated_;
  const bool done = file_.transaction([&] {
    if (!add_names(batch)) return false;
    Grown grown;  // the longer periods, each of which is summed up once
    for (const PeriodData& data : batch.periods)
      if (!add_period(data, grown) || !add_channels(data)) return false;
    for (const auto& [period_s, start_us] : grown)
      if (!add_longer(period_s, start_us)) return false;
    for (const event_t& event : batch.events)
      if (!add_event(event)) return false;
    for (const acknowledged_t& acknowledged : batch.acknowledged)
      if (!add_acknowledged(acknowledged)) return false;
    if (!add_weather(batch.weather)) return false;
    return batch.periods.empty() || forget_values(batch.periods.back().start_us);
  });
  if (done) return {};
  repeated_ = repeated;
  return file_.error();
}

bool SummaryStore::add_names(const SummaryBatch& batch) {
  const parameter_table_t& t = batch.parameters;
  if (!t.name.empty()) {
    SqliteStatement config = file_.prepare(
        "INSERT OR IGNORE INTO config (sha256, structure, version, first_us) VALUES (?, ?, ?, ?)");
    config.bind(1, t.config_sha256).bind(2, t.structure).bind(3, t.version).bind(4, t.time_us);
    if (!config.run()) return false;
  }
  parameter_ids_.clear();
  SqliteStatement put = file_.prepare(
      "INSERT OR IGNORE INTO parameter (name, unit, kind, story) VALUES (?, ?, ?, ?)");
  SqliteStatement find = file_.prepare("SELECT id FROM parameter WHERE name = ? AND unit = ?");
  for (std::size_t p = 0; p < t.name.size(); ++p) {
    put.bind(1, t.name[p]).bind(2, t.unit[p]).bind(3, std::int64_t{t.kind[p]});
    put.bind(4, std::int64_t{t.story[p]});
    find.bind(1, t.name[p]).bind(2, t.unit[p]);
    if (!put.run() || !find.row()) return false;
    parameter_ids_.push_back(find.integer(0));
    find.again();
  }
  channel_ids_.clear();
  SqliteStatement put_channel = file_.prepare("INSERT OR IGNORE INTO channel (name) VALUES (?)");
  SqliteStatement find_channel = file_.prepare("SELECT id FROM channel WHERE name = ?");
  for (const std::string& name : batch.channels) {
    put_channel.bind(1, name);
    find_channel.bind(1, name);
    if (!put_channel.run() || !find_channel.row()) return false;
    channel_ids_.push_back(find_channel.integer(0));
    find_channel.again();
  }
  return true;
}

bool SummaryStore::add_period(const PeriodData& data, Grown& grown) {
  if (data.parameters.empty() || data.parameters.size() != parameter_ids_.size()) return true;
  const std::int64_t period_s = settings_.summary_s.front();
  SqliteStatement there =
      file_.prepare("SELECT open, last_us FROM period WHERE period_s = ? AND start_us = ?");
  there.bind(1, period_s).bind(2, data.start_us);
  const bool known = there.row(), late = data.windows == 0;
  if (!known && late) return true;
  if (known && (there.integer(0) == 0 || (!late && data.last_us <= there.integer(1)))) {
    ++repeated_;
    return true;
  }
  there.again();
  SqliteStatement period = file_.prepare(
      "INSERT INTO period (period_s, start_us, windows, last_us, open) VALUES (?, ?, ?, ?, 1)"
      " ON CONFLICT DO UPDATE SET windows = windows + excluded.windows,"
      " last_us = max(last_us, excluded.last_us)");
  period.bind(1, period_s).bind(2, data.start_us).bind(3, data.windows).bind(4, data.last_us);
  if (!period.run()) return false;

  SqliteStatement before = file_.prepare(
      "SELECT observable, mean, std_error, min, max, box FROM summary"
      " JOIN open_values USING (parameter, start_us)"
      " WHERE parameter = ? AND period_s = ? AND start_us = ?");
  SqliteStatement values = file_.prepare(
      "INSERT OR REPLACE INTO open_values (parameter, start_us, box) VALUES (?, ?, ?)");
  SqliteStatement put = file_.prepare(kPutSummary);
  // Other pieces and longer periods need the values again.
  const bool keeps = !data.whole || settings_.summary_s.size() > 1;
  for (std::size_t p = 0; p < parameter_ids_.size(); ++p) {
    ParameterData d = data.parameters[p];
    std::vector<double> box;
    before.bind(1, parameter_ids_[p]).bind(2, period_s).bind(3, data.start_us);
    if (before.row()) {
      const auto n = static_cast<double>(before.integer(0));
      box = before.numbers(5);
      if (n > 0) {
        d.observable += before.integer(0);
        d.sum += n * before.number(1);
        d.error_squares += n * before.number(2) * before.number(2);
        d.min = std::min(d.min, before.number(3));
        d.max = std::max(d.max, before.number(4));
      }
    }
    before.again();
    box.insert(box.end(), d.box.begin(), d.box.end());
    if (keeps) {
      values.bind(1, parameter_ids_[p]).bind(2, data.start_us);
      values.bind(3, std::span<const double>(box));
      if (!values.run()) return false;
    }
    const auto n = static_cast<double>(d.observable);
    put.bind(1, parameter_ids_[p]).bind(2, period_s).bind(3, data.start_us);
    bind_summary(put, 4, d.observable, n > 0 ? d.sum / n : estimator::kNaN,
                 n > 0 ? std::sqrt(d.error_squares / n) : estimator::kNaN,
                 n > 0 ? d.min : estimator::kNaN, n > 0 ? d.max : estimator::kNaN, box);
    if (!put.run()) return false;
  }
  for (std::size_t i = 1; i < settings_.summary_s.size(); ++i)
    grown.emplace(settings_.summary_s[i], start_of(data.start_us, settings_.summary_s[i]));
  return true;
}

/// Sums up a longer period from the shortest periods in it so far.
bool SummaryStore::add_longer(std::int64_t period_s, std::int64_t start_us) {
  const std::int64_t first_s = settings_.summary_s.front();
  const std::int64_t end_us = start_us + period_s * kSecond_us;
  SqliteStatement closed =
      file_.prepare("SELECT 1 FROM period WHERE period_s = ? AND start_us = ? AND open = 0");
  closed.bind(1, period_s).bind(2, start_us);
  if (closed.row()) return true;
  SqliteStatement period = file_.prepare(
      "INSERT OR REPLACE INTO period (period_s, start_us, windows, last_us, open)"
      " SELECT ?, ?, sum(windows), max(last_us), 1 FROM period"
      " WHERE period_s = ? AND start_us >= ? AND start_us < ?");
  period.bind(1, period_s).bind(2, start_us).bind(3, first_s).bind(4, start_us).bind(5, end_us);
  if (!period.run()) return false;
  SqliteStatement sums = file_.prepare(
      "SELECT sum(observable), sum(observable * mean) / sum(observable),"
      " sqrt(sum(observable * std_error * std_error) / sum(observable)), min(min), max(max)"
      " FROM summary WHERE parameter = ? AND period_s = ? AND start_us >= ? AND start_us < ?");
  SqliteStatement values = file_.prepare(
      "SELECT box FROM open_values WHERE parameter = ? AND start_us >= ? AND start_us < ?");
  SqliteStatement put = file_.prepare(kPutSummary);
  for (const std::int64_t id : parameter_ids_) {
    sums.bind(1, id).bind(2, first_s).bind(3, start_us).bind(4, end_us);
    values.bind(1, id).bind(2, start_us).bind(3, end_us);
    if (!sums.row()) return false;
    std::vector<double> box;
    while (values.row()) {
      const std::vector<double> part = values.numbers(0);
      box.insert(box.end(), part.begin(), part.end());
    }
    put.bind(1, id).bind(2, period_s).bind(3, start_us);
    bind_summary(put, 4, sums.integer(0), sums.number(1), sums.number(2), sums.number(3),
                 sums.number(4), box);
    sums.again();
    values.again();
    if (!put.run()) return false;
  }
  return true;
}

bool SummaryStore::add_channels(const PeriodData& data) {
  if (data.channels.empty() || data.channels.size() != channel_ids_.size()) return true;
  SqliteStatement put = file_.prepare(
      "INSERT INTO channel_summary (channel, period_s, start_us, received, lost, late, repaired,"
      " rejected, stuck, clipped, noise) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
      " ON CONFLICT DO UPDATE SET received = received + excluded.received,"
      " lost = lost + excluded.lost, late = late + excluded.late,"
      " repaired = repaired + excluded.repaired, rejected = rejected + excluded.rejected,"
      " stuck = stuck + excluded.stuck, clipped = clipped + excluded.clipped,"
      " noise = coalesce(excluded.noise, noise)");
  for (const std::int64_t period_s : settings_.summary_s)
    for (std::size_t c = 0; c < channel_ids_.size(); ++c) {
      put.bind(1, channel_ids_[c]).bind(2, period_s).bind(3, start_of(data.start_us, period_s));
      for (int i = 0; i < ChannelData::kCounts; ++i)
        put.bind(4 + i, data.channels[c].counts[static_cast<std::size_t>(i)]);
      put.bind(4 + ChannelData::kCounts, data.channels[c].noise);
      if (!put.run()) return false;
    }
  return true;
}

/// Keeps the values of the longest current period and of the one before it.
bool SummaryStore::forget_values(std::int64_t newest_us) {
  const std::int64_t longest_s = settings_.summary_s.back();
  const std::int64_t from_us = start_of(newest_us, longest_s) - longest_s * kSecond_us;
  const std::int64_t to_us = from_us + 3 * longest_s * kSecond_us;
  for (const char* sql : {"DELETE FROM open_values WHERE start_us < ? OR start_us >= ?",
                          "UPDATE period SET open = 0 WHERE open = 1 AND"
                          " (start_us < ? OR start_us >= ?)"}) {
    SqliteStatement s = file_.prepare(sql);
    s.bind(1, from_us).bind(2, to_us);
    if (!s.run()) return false;
  }
  return true;
}

bool SummaryStore::add_event(const event_t& e) {
  SqliteStatement put = file_.prepare(
      "INSERT OR IGNORE INTO event (kind, id, time_us, state, since_us, severity, place, value,"
      " std_error, unit, message, segment) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  put.bind(1, e.kind).bind(2, e.id).bind(3, e.time_us).bind(4, std::int64_t{e.state});
  put.bind(5, e.since_us).bind(6, std::int64_t{e.severity}).bind(7, e.place).bind(8, e.value);
  put.bind(9, e.std_error).bind(10, e.unit).bind(11, e.message).bind(12, e.segment);
  return put.run();
}

bool SummaryStore::add_acknowledged(const acknowledged_t& a) {
  SqliteStatement put = file_.prepare(
      "INSERT OR IGNORE INTO acknowledgement (kind, id, time_us, place, who, comment)"
      " VALUES (?, ?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < a.id.size(); ++i) {
    put.bind(1, a.kind[i]).bind(2, a.id[i]).bind(3, a.since_us[i]);
    put.bind(4, a.place[i]).bind(5, a.who[i]).bind(6, a.comment[i]);
    if (!put.run()) return false;
  }
  return true;
}

/// Adds readings to the means of their hours. Ignores readings that are not newer than the newest
/// of their hour: they were stored before.
bool SummaryStore::add_weather(const std::vector<WeatherReading>& readings) {
  if (readings.empty()) return true;
  SqliteStatement name = file_.prepare("INSERT OR IGNORE INTO covariate (name) VALUES (?)");
  SqliteStatement put = file_.prepare(
      "INSERT INTO weather (covariate, start_us, readings, mean, min, max, last_us)"
      " SELECT id, ?1, 1, ?2, ?2, ?2, ?3 FROM covariate WHERE name = ?4"
      " ON CONFLICT DO UPDATE SET mean = mean + (excluded.mean - mean) / (readings + 1),"
      " readings = readings + 1, min = min(min, excluded.min), max = max(max, excluded.max),"
      " last_us = excluded.last_us WHERE excluded.last_us > last_us");
  for (const WeatherReading& r : readings) {
    name.bind(1, r.name);
    put.bind(1, start_of(r.time_us, kHour_s)).bind(2, r.value).bind(3, r.time_us).bind(4, r.name);
    if (!name.run() || !put.run()) return false;
  }
  return true;
}

std::string SummaryStore::prune(std::int64_t newest_us) {
  const std::int64_t period_s = settings_.summary_s.front();
  const auto keep_us = static_cast<std::int64_t>(kDay_us * settings_.keep_summary_days);
  if (newest_us < keep_us) return {};
  const std::int64_t before_us = newest_us - keep_us;
  const bool done = file_.transaction([&] {
    for (const char* sql : {"DELETE FROM summary WHERE parameter IN (SELECT id FROM parameter)"
                            " AND period_s = ? AND start_us < ?",
                            "DELETE FROM channel_summary WHERE channel IN (SELECT id FROM channel)"
                            " AND period_s = ? AND start_us < ?",
                            "DELETE FROM period WHERE period_s = ? AND start_us < ?"}) {
      SqliteStatement s = file_.prepare(sql);
      s.bind(1, period_s).bind(2, before_us);
      if (!s.run()) return false;
    }
    return file_.execute("PRAGMA incremental_vacuum(1000)");
  });
  return done ? "" : file_.error();
}

}  // namespace framewatch::daemon
