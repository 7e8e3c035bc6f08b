#include "daemon/monitor/actions/action_queue.h"

#include <algorithm>
#include <string>

#include "daemon/monitor/events/event_words.h"

namespace framewatch::daemon {
namespace {

constexpr double kMinute_us = 60e6;

}  // namespace

bool ActionQueue::wanted(const event_t& e) const {
  const std::vector<std::string>& kinds = settings_.kinds;
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

std::optional<event_t> ActionQueue::take(std::int64_t now_us) {
  const auto full = static_cast<double>(settings_.per_minute);
  if (tokens_ < 0) tokens_ = full;
  tokens_ += full * static_cast<double>(now_us - filled_us_) / kMinute_us;
  tokens_ = std::min(tokens_, full);
  filled_us_ = now_us;
  auto next = waiting_.end();
  for (auto at = waiting_.begin(); at != waiting_.end(); ++at) {
    if (at->second.due_us > now_us) continue;
    if (next == waiting_.end() || std::pair(-at->second.event.severity, at->second.order) <
                                      std::pair(-next->second.event.severity, next->second.order))
      next = at;
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
  event_t event = std::move(waiting_.begin()->second.event);
  waiting_.erase(waiting_.begin());
  return event;
}

}  // namespace framewatch::daemon
