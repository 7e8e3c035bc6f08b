// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history.h"

#include <algorithm>
#include <csignal>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kCalm_us =
    5'000'000;  // without trouble for this time before the event is cleared

}  // namespace

History::History(const Config& config)
    : config_(config),
      keeper_(*config.history),
      summaries_(config),
      raw_(config,
           [this](std::unique_ptr<drivers::DurableFile> log) { keeper_.retire(std::move(log)); }) {}

History::~History() {
  raw_.finish();
}

void History::tick(std::int64_t now_us) {
  raw_.tick(now_us);
  if (raw_.counters().samples > 0) keeper_.newest(raw_.newest_us());
}

history_status_t History::status() const {
  const RawHistory::Counters raw = raw_.counters();
  SummaryHistory::Counters summaries = summaries_.counters();
  const HistoryKeeper::Room room = keeper_.room();
  history_status_t out{};
  out.time_us = raw_.newest_us();
  out.directory = config_.history->directory;
  out.raw_samples = raw.samples;
  out.raw_dropped = raw.dropped;
  out.raw_bytes = raw.bytes;
  out.raw_queue_bytes = static_cast<std::int64_t>(raw.queued);
  out.raw_trouble = raw_.trouble();
  out.summary_commits = summaries.commits;
  out.summary_until_us = summaries.until_us;
  out.summary_dropped = summaries.dropped;
  out.summary_trouble = std::move(summaries.trouble);
  out.stored_bytes = room.stored_bytes;
  out.disk_free_bytes = room.free_bytes;
  return out;
}

std::vector<event_t> HistoryMonitor::update(std::int64_t now_us, const history_status_t& status,
                                            const SetAside& set_aside) {
  std::vector<event_t> out;
  if (auto e = news(raw_, "raw", status.raw_trouble, status.raw_dropped, status, now_us))
    out.push_back(std::move(*e));
  if (auto e = news(summaries_, "summaries", status.summary_trouble, status.summary_dropped, status,
                    now_us))
    out.push_back(std::move(*e));
  if (auto e = new_database(set_aside, status, now_us)) out.push_back(std::move(*e));
  return out;
}

std::optional<event_t> HistoryMonitor::new_database(const SetAside& set_aside,
                                                    const history_status_t& status,
                                                    std::int64_t now_us) {
  if (set_aside.count <= std::exchange(set_aside_seen_, set_aside.count)) return std::nullopt;
  const std::int64_t time_us = status.raw_samples > 0 ? status.time_us : now_us;
  const bool first = database_.id == 0;
  if (first) {
    database_.since_us = time_us;
    database_.id = time_us + 2;
  }
  database_.time_us = time_us;
  database_.state = first ? event_state::raised : event_state::changed;
  database_.severity = severity::alarm;
  database_.kind = "history";
  database_.place = "database";
  database_.value = static_cast<double>(set_aside.count);
  database_.unit = "databases";
  database_.message = fmt::format(
      "the database is unusable: {}. Check the disk, and who else writes there", set_aside.words());
  return database_;
}

std::optional<event_t> HistoryMonitor::news(Part& part, const char* place,
                                            const std::string& trouble, std::int64_t lost,
                                            const history_status_t& status, std::int64_t now_us) {
  const std::int64_t seen = std::exchange(part.lost_seen, lost);
  const bool bad = !trouble.empty() || lost > seen;
  if (bad || !part.raised) part.well_since_us = now_us;
  if (bad == part.raised || (!bad && now_us - part.well_since_us < kCalm_us)) return std::nullopt;
  part.raised = bad;
  if (bad) {
    part.since_us = status.time_us;
    part.id = status.time_us + (place == std::string("raw") ? 0 : 1);  // both may begin at once
    part.lost_before = seen;
  }
  event_t e{};
  e.time_us = status.time_us;
  e.since_us = part.since_us;
  e.id = part.id;
  e.state = bad ? event_state::raised : event_state::cleared;
  e.severity = bad ? severity::alarm : severity::information;
  e.kind = "history";
  e.place = place;
  e.value = static_cast<double>(lost - part.lost_before);
  e.unit = place == std::string("raw") ? "samples" : "windows";
  const char* const what = place == std::string("raw") ? "raw samples" : "summaries";
  e.message = bad ? fmt::format("cannot write {}: {}. Estimates continue. Check the disk", what,
                                trouble.empty() ? "the disk is too slow" : trouble)
                  : fmt::format("writing {} again; {:.0f} {} were lost", what, e.value, e.unit);
  return e;
}

HistoryReport::HistoryReport(const Config& config, lcm::LCM& lcm) : config_(config), lcm_(lcm) {
  if (!config.history) return;
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit then is an error like a full disk
  history_.emplace(config);
  if (config.watch) losses_.emplace(config);
}

/// Returns the events of new lasting losses.
std::vector<event_t> HistoryReport::losses(const history_status_t& status, std::int64_t now_us) {
  if (!losses_) return {};
  // A clock that is ahead shows days that are not over.
  const bool stored = status.summary_until_us > 0 && status.raw_samples > 0;
  LossMonitor::News news = losses_->update(
      stored ? std::min({status.summary_until_us, status.time_us, now_us}) : INT64_MIN);
  for (const event_t& event : news.before.all()) {
    raised_.note(event);
    if (const Acknowledgement* by = news.before.acknowledgement(event.id))
      raised_.acknowledge(event.id, *by);
  }
  if (!news.problem.empty())
    unread_(now_us, "lasting losses: cannot read the history: " + news.problem);
  return std::move(news.events);
}

std::vector<event_t> HistoryReport::update(std::int64_t now_us) {
  if (!history_) return {};
  history_->tick(steady_clock_us());
  if (!second_.due(now_us)) return {};
  const history_status_t status = history_->status();
  lcm_.publish(config_.lcm.prefix + "HISTORY", &status);
  const std::string channel = config_.lcm.prefix + "EVENT";
  std::vector<event_t> news = monitor_.update(now_us, status, history_->set_aside());
  for (event_t& event : losses(status, now_us)) news.push_back(std::move(event));
  for (const event_t& event : news) {
    log(event.state != event_state::cleared ? LogLevel::error : LogLevel::notice,
        event.kind + ": " + event.message);
    const std::vector<std::uint8_t> bytes = drivers::encoded(event);
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    history_->message(channel, bytes);
    raised_.note(event);
  }
  return news;
}

}  // namespace framewatch::daemon
