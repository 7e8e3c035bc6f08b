// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/notifier.h"

#include <algorithm>
#include <chrono>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/caught.h"

namespace framewatch::daemon {
namespace {

constexpr double kMinute_us = 60e6;

constexpr std::chrono::milliseconds kLook{100};
constexpr std::int64_t kPatienceAtEnd_us = 2'000'000;
constexpr double kFirstWait_s = 1, kLongestWait_s = 60;
constexpr double kLongestPause_s = 3600;  // that a receiver may ask for

}  // namespace

bool ActionQueue::wanted(const event_t& e) const {
  const std::vector<std::string>& kinds = settings_.kinds;
  if (e.kind == kWellKind) return true;  // it is asked for by its time
  return e.severity >= settings_.severity &&
         (kinds.empty() || std::find(kinds.begin(), kinds.end(), e.kind) != kinds.end());
}

void ActionQueue::remember(const Key& key, std::int64_t now_us) {
  if (delivered_us_.size() >= kMaxDelivered && !delivered_us_.contains(key))
    delivered_us_.erase(std::min_element(delivered_us_.begin(), delivered_us_.end(),
                                         [](auto& a, auto& b) { return a.second < b.second; }));
  delivered_us_[key] = now_us;
}

void ActionQueue::delivered_before(const event_t& e) {
  if (wanted(e)) remember({e.kind, e.id}, INT64_MIN / 2);
}

int ActionQueue::put(const event_t& e, bool acknowledged, std::int64_t now_us) {
  const Key key{e.kind, e.id};
  const auto same = waiting_.find(key);
  const auto delivered = delivered_us_.find(key);
  const bool over = e.state == event_state::cleared;
  const bool momentary = over && e.since_us == e.time_us;
  if (over && delivered == delivered_us_.end() && same == waiting_.end() &&
      !(momentary && wanted(e)))
    return 0;
  if (!over && (acknowledged || !wanted(e))) {
    if (acknowledged && same != waiting_.end()) waiting_.erase(same);
    return 0;
  }
  const std::int64_t due_us =
      e.state == event_state::changed && delivered != delivered_us_.end()
          ? delivered->second + static_cast<std::int64_t>(1e6 * settings_.changed_every_s)
          : now_us;
  if (same != waiting_.end()) {
    ++merged_;
    Waiting& waiting = same->second;
    const bool first = waiting.event.state == event_state::raised && !over;
    waiting = {e, std::min(waiting.due_us, due_us), waiting.order};
    if (first) waiting.event.state = event_state::raised;
    return 0;
  }
  waiting_.emplace(key, Waiting{e, due_us, order_++});
  if (waiting_.size() <= kMax) return 0;
  const auto least = std::min_element(waiting_.begin(), waiting_.end(), [](auto& a, auto& b) {
    return std::pair(a.second.event.severity, -a.second.order) <
           std::pair(b.second.event.severity, -b.second.order);
  });
  if (least->second.event.state == event_state::cleared) delivered_us_.erase(least->first);
  waiting_.erase(least);
  return 1;
}

void ActionQueue::acknowledged(const event_t& e) {
  const Key key{e.kind, e.id};
  const auto waiting = waiting_.find(key);
  if (waiting == waiting_.end() || waiting->second.event.state == event_state::cleared) return;
  waiting_.erase(waiting);
  if (!delivered_us_.contains(key)) remember(key, INT64_MIN / 2);
}

std::optional<event_t> ActionQueue::take(std::int64_t now_us, int least_severity) {
  const auto full = static_cast<double>(settings_.per_minute);
  if (tokens_ < 0) tokens_ = full;
  tokens_ += full * static_cast<double>(now_us - filled_us_) / kMinute_us;
  tokens_ = std::min(tokens_, full);
  filled_us_ = now_us;
  auto next = waiting_.end();
  for (auto at = waiting_.begin(); at != waiting_.end(); ++at) {
    if (at->second.due_us > now_us || at->second.event.severity < least_severity) continue;
    if (next == waiting_.end() || at->second.goes_before(next->second)) next = at;
  }
  if (next == waiting_.end() || tokens_ < 1) return std::nullopt;
  tokens_ -= 1;
  event_t event = std::move(next->second.event);
  if (event.state == event_state::cleared)
    delivered_us_.erase(next->first);
  else
    remember(next->first, now_us);
  waiting_.erase(next);
  return event;
}

std::optional<event_t> ActionQueue::take_any() {
  if (waiting_.empty()) return std::nullopt;
  const auto next = std::min_element(waiting_.begin(), waiting_.end(), [](auto& a, auto& b) {
    return a.second.goes_before(b.second);
  });
  event_t event = std::move(next->second.event);
  waiting_.erase(next);
  return event;
}

Notifier::Notifier(std::string name, Deliver deliver)
    : name_(std::move(name)), deliver_(std::move(deliver)), thread_([this] { work(); }) {}

Notifier::~Notifier() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
    give_up_us_ = steady_clock_us() + kPatienceAtEnd_us;
  }
  wake_.notify_one();
  thread_.join();
}

void Notifier::configure(const ActionSettings& settings, double patience_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  settings_ = settings;
  patience_s_ = patience_s;
  quiet_ = QuietHours(settings);
  queue_.configure(settings);
}

void Notifier::delivered_before(const event_t& event) {
  const std::lock_guard<std::mutex> lock(mutex_);
  queue_.delivered_before(event);
}

void Notifier::event(const event_t& event, bool acknowledged) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const int lost = queue_.put(event, acknowledged, steady_clock_us());
    if (lost > 0) lose(lost, "too many events are waiting");
  }
  wake_.notify_one();
}

void Notifier::acknowledged(const event_t& event) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    queue_.acknowledged(event);
    needless_ = needless_ || (repeatable_ && *repeatable_ == std::pair(event.kind, event.id));
  }
  wake_.notify_one();
}

Notifier::Counters Notifier::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Counters out = counters_;
  out.merged = queue_.merged();
  out.waiting += static_cast<std::int64_t>(queue_.waiting());
  return out;
}

/// Requires that the caller holds the mutex.
void Notifier::lose(std::int64_t events, const std::string& why) {
  counters_.lost += events;
  counters_.lost_us = host_clock_us();
  losses_(host_clock_us(), fmt::format("{}: {} events were lost: {}", name_, events, why));
}

bool Notifier::abandoned() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return steady_clock_us() >= give_up_us_;
}

void Notifier::work() {
  for (;;) {
    std::optional<event_t> event;
    ActionSettings settings;
    double patience_s = 0;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      const bool late = steady_clock_us() >= give_up_us_;
      if (stop_ && (late || queue_.waiting() == 0)) {
        if (queue_.waiting() > 0)
          lose(static_cast<std::int64_t>(queue_.waiting()), "framewatch stops");
        return;
      }
      event = stop_ ? queue_.take_any()
                    : queue_.take(steady_clock_us(), quiet_.least_severity(host_clock_us()));
      if (!event) {
        wake_.wait_for(lock, kLook);
        continue;
      }
      settings = settings_;
      patience_s = patience_s_;
      counters_.waiting = 1;
      needless_ = false;
      if (event->state != event_state::cleared) repeatable_.emplace(event->kind, event->id);
    }
    bool delivered = false;
    const std::string thrown =
        drivers::caught([&] { delivered = deliver_one(settings, patience_s, *event); });
    const std::lock_guard<std::mutex> lock(mutex_);
    counters_.waiting = 0;
    repeatable_.reset();
    if (!thrown.empty()) counters_.trouble = thrown;
    if (delivered)
      ++counters_.told;
    else if (!needless_)
      lose(1, fmt::format("{}; the event was \"{}\"", counters_.trouble, event->message));
  }
}

bool Notifier::deliver_one(ActionSettings settings, double patience_s, const event_t& event) {
  const std::int64_t began_us = steady_clock_us();
  for (double wait_s = kFirstWait_s;; wait_s = std::min(2 * wait_s, kLongestWait_s)) {
    DeliveryResult result = deliver_(settings, event, [this] { return abandoned(); });
    std::unique_lock<std::mutex> lock(mutex_);
    const std::string before = std::exchange(counters_.trouble, result.trouble);
    if (result.trouble.empty()) {
      if (!before.empty()) log(LogLevel::notice, name_ + ": works again");
      return true;
    }
    if (result.trouble != before) log(LogLevel::warning, name_ + ": " + result.trouble);
    if (result.partly) return true;
    const double asked_s = std::min(result.retry_after_s, kLongestPause_s);
    const auto wait_us = static_cast<std::int64_t>(1e6 * std::max(wait_s, asked_s));
    const std::int64_t until_us = began_us + static_cast<std::int64_t>(1e6 * patience_s);
    if (!result.retry || stop_ || needless_ || steady_clock_us() + wait_us > until_us) return false;
    wake_.wait_for(lock, std::chrono::microseconds(wait_us), [this] { return stop_ || needless_; });
    if (needless_) return false;
    settings = settings_;  // a reload may have corrected them
    patience_s = patience_s_;
  }
}

}  // namespace framewatch::daemon
