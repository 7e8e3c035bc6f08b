// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history.h"

#include <utility>

#include "drivers/files/encoded.h"

namespace framewatch::daemon {

History::History(const Config& config)
    : config_(config),
      keeper_(*config.history),
      summaries_(config),
      raw_(config,
           [this](std::unique_ptr<drivers::DurableFile> log) { keeper_.retire(std::move(log)); }) {}

History::~History() {
  raw_.finish();
}

void History::temperature(const temperature_t& temperature) {
  raw_.message(config_.watch->temperature_channel, temperature.time_us,
               drivers::encoded(temperature));
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

}  // namespace framewatch::daemon
