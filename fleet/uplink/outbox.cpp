#include "fleet/uplink/outbox.h"

#include <sys/stat.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"

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

/// A database that was set aside is another file afterwards.
std::string Outbox::open() {
  const std::string path = daemon::summary_file(directory_);
  struct ::stat now {};
  if (::stat(path.c_str(), &now) != 0) {
    file_.close();
    return "there is no history yet";
  }
  if (file_.is_open() && !file_.failed() && now.st_dev == device_ && now.st_ino == number_)
    return {};
  version_ = -1;
  if (!file_.open_to_read(path)) return file_.error();
  device_ = now.st_dev;
  number_ = now.st_ino;
  std::string problem = daemon::version_problem(file_, daemon::history_schema());
  if (!problem.empty()) file_.close();
  return problem;
}

bool Outbox::has_news() {
  if (!open().empty()) return true;
  SqliteStatement s = file_.prepare("PRAGMA data_version");
  return !s.row() || s.integer(0) != version_;
}

std::string Outbox::look(SentStore& sent, Waiting& out) {
  if (std::string problem = open(); !problem.empty()) return problem;
  SqliteStatement version = file_.prepare("PRAGMA data_version");
  const std::int64_t version_now = version.row() ? version.integer(0) : -1;
  SqliteStatement newest = file_.prepare("SELECT max(last_us) FROM period WHERE period_s = ?");
  newest.bind(1, summary_s_.front());
  newest_us_ = newest.row() && !newest.null(0) ? std::optional(newest.integer(0)) : std::nullopt;
  newest.again();

  Waiting found;
  look_for_events(sent, found);
  if (newest_us_) {
    const bool alone = summary_s_.size() == 1;
    for (std::size_t i = alone ? 0 : 1; i < summary_s_.size(); ++i)
      look_for_periods(sent, summary_s_[i], kEver, found);
    if (!alone)
      for (const TimeRange& time : wanted_minutes(sent))
        look_for_periods(sent, summary_s_.front(), time, found);
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

/// Both tables in the order of their keys, step by step.
void Outbox::look_for_events(SentStore& sent, Waiting& out) {
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

/// A period is over when a later window has been stored. One that grew afterwards, because the
/// sensors' clock was set back, is sent again when it is closed for good.
void Outbox::look_for_periods(SentStore& sent, std::int64_t period_s, const TimeRange& time,
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

}  // namespace framewatch::fleet
