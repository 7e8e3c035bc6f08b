// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/history_output.h"

#include <algorithm>

#include "daemon/base/clocks.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxNews = 10000;  // events or readings in memory before they are stored

}  // namespace

HistoryOutput::HistoryOutput(const Config& config)
    : settings_(config.history.value_or(HistorySettings{})),
      intake_(config.lcm.prefix, settings_.summary_s.front(), [this] { (void)store(); }),
      store_(settings_) {}

bool HistoryOutput::fail(const std::string& why) {
  if (error_.empty()) error_ = why;
  return false;
}

bool HistoryOutput::open(const std::string& path) {
  if (!file_.open(path)) return fail(file_.error());
  const std::string problem = store_.open_new(path + ".partial");
  return problem.empty() || fail(problem);
}

void HistoryOutput::keep(std::int64_t from_us, std::int64_t to_us) {
  from_us_ = from_us;
  to_us_ = to_us;
}

bool HistoryOutput::put(std::int64_t, const std::string& channel,
                        const std::vector<std::uint8_t>& bytes) {
  const auto kind = intake_.kind_of(channel);
  if (!kind) return error_.empty();
  intake_.take(*kind, bytes);
  // Store one longest period at a time, so that each is summed up once.
  const SummaryBatch& waits = intake_.batch();
  const auto most = static_cast<std::size_t>(longest_s() / settings_.summary_s.front());
  const bool full = waits.periods.size() > most || waits.events.size() > kMaxNews ||
                    waits.weather.size() > kMaxNews;
  return full ? store() : error_.empty();
}

bool HistoryOutput::store() {
  if (!error_.empty()) return false;
  SummaryBatch& batch = intake_.batch();
  const auto left_out = [&](std::int64_t time_us) {
    return time_us < from_us_ || time_us >= to_us_;
  };
  std::erase_if(batch.periods, [&](const PeriodData& p) { return left_out(p.start_us); });
  std::erase_if(batch.events, [&](const event_t& e) { return left_out(e.time_us); });
  std::erase_if(batch.weather, [&](const WeatherReading& w) { return left_out(w.time_us); });
  const std::string problem = batch.empty() ? "" : store_.add(batch);
  batch.periods.clear();
  batch.events.clear();
  batch.acknowledged.clear();
  batch.weather.clear();
  return problem.empty() || fail(problem);
}

bool HistoryOutput::close() {
  intake_.end_period();
  const bool stored = store();
  store_.close();
  return (stored && file_.commit()) || fail(file_.error());
}

}  // namespace framewatch::daemon
