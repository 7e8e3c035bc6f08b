// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/summary_history.h"

#include <algorithm>
#include <utility>

#include <framewatch/event_t.hpp>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_query.h"
#include "drivers/files/caught.h"

namespace framewatch::daemon {
namespace {

constexpr std::chrono::milliseconds kBetweenPuts{200};
constexpr std::chrono::seconds kAgain{1};  // pause after a failed commit
constexpr std::chrono::hours kPrune{1};

}  // namespace

SummaryHistory::SummaryHistory(const Config& config)
    : config_(config),
      store_(*config.history),
      intake_(config.lcm.prefix, config.history->summary_s.front(), [this] { commit(); }),
      next_commit_(Clock::now()),
      next_prune_(next_commit_),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

void SummaryHistory::message(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  const auto kind = intake_.kind_of(channel);
  if (!kind) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (queued_ + bytes.size() > kQueueBytes) {
    counters_.dropped += *kind != SummaryIntake::Kind::table &&
                         *kind != SummaryIntake::Kind::status &&
                         *kind != SummaryIntake::Kind::weather;
    return;
  }
  queued_ += bytes.size();
  queue_.push_back({*kind, bytes});
}

SummaryHistory::Counters SummaryHistory::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

void SummaryHistory::work(const std::stop_token& stop) {
  // Reads the stored periods before the first window comes.
  guarded(0, [this] { commit(); });
  for (bool last = false; !last;) {
    std::vector<Message> messages;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait_for(lock, stop, kBetweenPuts, [] { return false; });
      last = stop.stop_requested();
      messages.swap(queue_);
      queued_ = 0;
    }
    guarded(messages.size(), [&] {
      for (const Message& message : messages) {
        const SummaryIntake::Taken taken = intake_.take(message.kind, message.bytes);
        if (taken.period) next_commit_ = std::min(next_commit_, Clock::now());
        if (taken.news) next_commit_ = std::min(next_commit_, Clock::now() + kAgain);
      }
      if (store_.is_replaced() && begin_anew("it was removed or replaced while in use", {}))
        next_commit_ = Clock::now();
      const bool due = Clock::now() >= next_commit_;
      // Ends the period even if the sensors fall silent in the middle of it.
      if ((last || (due && waiting().empty())) && intake_.end_period())
        next_commit_ = std::min(next_commit_, Clock::now());
      if (last || due) commit();
    });
  }
}

/// An exception, such as a lack of memory, costs the messages of one round, not the program.
void SummaryHistory::guarded(std::size_t messages, const std::function<void()>& round) {
  const std::string thrown = drivers::caught(round);
  if (thrown.empty()) return;
  store_.close();
  next_commit_ = Clock::now() + kAgain;
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_.dropped += static_cast<std::int64_t>(messages);
  counters_.trouble = thrown;
}

std::string SummaryHistory::store_waiting() {
  if (!store_.is_open()) {
    if (std::string problem = store_.open(); !problem.empty()) return problem;
    for (const auto& [start_us, last_us] : store_.open_periods())
      intake_.collector().taken(start_us, last_us);
  }
  if (store_.corrupt()) return "the database is corrupt";
  return waiting().empty() ? "" : store_.add(waiting());
}

/// Returns the events that the database has, as far as they can be read.
std::vector<event_t> SummaryHistory::readable_events() const {
  SummaryQuery old;
  if (!old.open(config_.history->directory).empty()) return {};
  return old.events(-kEver_us, kEver_us, kMaxEvents);
}

/// Sets an unusable database aside; the next one begins with the events of `readable`. Returns
/// false if that fails.
bool SummaryHistory::begin_anew(const std::string& reason, const std::vector<event_t>& readable) {
  const std::string database = summary_file(config_.history->directory);
  SetAside aside = counters().set_aside;
  set_aside_database(database, host_clock_us(), reason, aside);
  store_.close();  // SQLite removes the log of that name, which may by now be another file's
  if (aside.problem.empty()) {
    log(LogLevel::error, fmt::format("history: {}: {} with {} of its events", database,
                                     aside.words(), readable.size()));
    waiting().events.insert(waiting().events.begin(), readable.begin(), readable.end());
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_.set_aside = aside;
  return aside.problem.empty();
}

void SummaryHistory::commit() {
  const auto period = std::chrono::seconds(config_.history->summary_s.front());
  next_commit_ = Clock::now() + period + kAgain;  // unless a period ends before
  std::string problem = store_waiting();
  if (store_.corrupt())
    problem =
        begin_anew(problem, readable_events()) ? store_waiting() : counters().set_aside.problem;
  if (waiting().empty() && problem.empty()) {
    const std::lock_guard<std::mutex> lock(mutex_);
    counters_.trouble.clear();
    return;
  }
  std::int64_t until_us = INT64_MIN;
  if (problem.empty()) {
    for (const PeriodData& data : waiting().periods) until_us = std::max(until_us, data.last_us);
    waiting().periods.clear();
    waiting().events.clear();
    waiting().acknowledged.clear();
    waiting().weather.clear();
  } else {
    next_commit_ = Clock::now() + kAgain;
    store_.close();  // after a failure of the disk the path may name another file
    bound();
  }
  if (store_.repeated() > std::exchange(repeated_said_, store_.repeated()))
    log(LogLevel::notice, "skipped windows of a time that was already summarized");
  const bool time_known = intake_.newest_us() != INT64_MIN;
  if (problem.empty() && time_known && Clock::now() >= next_prune_) {
    next_prune_ = Clock::now() + kPrune;
    problem = store_.prune(std::min(intake_.newest_us(), host_clock_us()));
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_.trouble = problem;
  if (!problem.empty()) return;
  ++counters_.commits;
  counters_.until_us = std::max(counters_.until_us, until_us);
}

void SummaryHistory::bound() {
  std::int64_t dropped = 0;
  while (waiting().periods.size() > kMaxPeriods) {
    dropped += waiting().periods.front().windows;
    waiting().periods.erase(waiting().periods.begin());
  }
  const auto bound_news = [&dropped](auto& news) {
    for (; news.size() > kMaxEvents; news.erase(news.begin())) ++dropped;
  };
  bound_news(waiting().events);
  bound_news(waiting().acknowledged);
  bound_news(waiting().weather);
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_.dropped += dropped;
}

}  // namespace framewatch::daemon
