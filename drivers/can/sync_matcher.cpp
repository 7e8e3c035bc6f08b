// SPDX-License-Identifier: MIT
#include "drivers/can/sync_matcher.h"

#include <algorithm>
#include <map>
#include <utility>

namespace framewatch::drivers {
namespace {

/// A frame that comes later after the SYNC than this share of the period may belong to another
/// SYNC.
constexpr double kWindow = 0.95;
/// The sender of the SYNC may be delayed, and no other stream gives the time.
constexpr double kPatience_us = 30e6;
/// Disagreements in a row after which a node's counter counts as restarted.
constexpr int kRestartedAfter = 5;
constexpr std::size_t kMaxUnassigned = 8;

StreamTimer::Settings settings_of(const CanBusMap& bus) {
  return {bus.sync_overflow > 0 ? CanTiming::counter : CanTiming::period, bus.sync_period_us,
          bus.sync_period_us, static_cast<double>(bus.sync_overflow), kPatience_us};
}

/// Returns `value` modulo 2^bits in [0, 2^bits).
std::int64_t wrapped(std::int64_t value, const CanField& counter) {
  const std::int64_t modulus = std::int64_t{1} << std::min(counter.bits, 62);
  return (value % modulus + modulus) % modulus;
}

/// Returns `value` modulo 2^bits in [-2^(bits-1), 2^(bits-1)).
std::int64_t nearest_zero(std::int64_t value, const CanField& counter) {
  const std::int64_t modulus = std::int64_t{1} << std::min(counter.bits, 62);
  const std::int64_t rest = wrapped(value, counter);
  return rest >= modulus / 2 ? rest - modulus : rest;
}

}  // namespace

SyncMatcher::SyncMatcher(const CanMap& map, int bus, HostClockSteps& steps,
                         StreamTimer::Deliver deliver)
    : bus_(map.buses[static_cast<std::size_t>(bus)]), timer_(settings_of(bus_), steps) {
  timer_.on_delivery(std::move(deliver));
  for (std::size_t n = 0; n < map.nodes.size(); ++n) {
    const CanNodeMap& node = map.nodes[n];
    if (node.bus != bus || node.timing != CanTiming::sync) continue;
    for (std::size_t m = 0; m < node.messages.size(); ++m) {
      Stream stream;
      stream.node = static_cast<int>(n);
      stream.message = static_cast<int>(m);
      stream.counter = node.messages[m].counter;
      streams_.push_back(std::move(stream));
    }
  }
}

void SyncMatcher::add(const CanFrame& frame, double host_us, TimedValues values) {
  const auto at = std::find_if(streams_.begin(), streams_.end(), [&](const Stream& s) {
    return s.node == values.node && s.message == values.message;
  });
  const double after_us = host_us - sync_us_;
  const bool in_window = after_us >= 0 && after_us <= kWindow * bus_.sync_period_us;
  if (sync_us_ < 0) {
    ++at->unplaced;
    return;
  }
  if (!at->counter && !in_window) {
    ++at->late;
    return;
  }
  const std::int64_t counter = at->counter ? raw_integer(*at->counter, frame.data) : 0;
  (at->count++ == 0 ? at->first : at->last) = Arrived{std::move(values), counter, in_window};
}

void SyncMatcher::sync(const CanFrame& frame, double host_us) {
  if (bus_.sync_overflow > 0 && frame.length != 1) return;
  flush();
  sync_us_ = host_us;
  timer_.open_sample(frame.data[0] % std::max<int>(bus_.sync_overflow, 1), host_us,
                     {-1, -1, 0, {}});
}

void SyncMatcher::flush() {
  if (sync_us_ < 0) return;
  vote_on_number();
  for (Stream& s : streams_) {
    if (s.count > 0) deliver(s);
    s.came_after_last_sync = std::exchange(s.count, 0) > 0;
    s.first.reset();
    s.last.reset();
  }
}

/// Numbers the SYNC as the counters of most nodes do. When it cannot have that number, the numbers
/// of the SYNC restarted, or the counters of all nodes did.
void SyncMatcher::vote_on_number() {
  const std::int64_t number = timer_.opened_number();
  std::map<std::int64_t, int> votes;  // by the difference to `number`
  int voters = 0;
  for (const Stream& s : streams_) {
    if (s.counter_at_sync < 0) continue;
    for (const auto* arrived : {&s.first, &s.last}) {
      if (!*arrived || !(*arrived)->in_window) continue;
      ++votes[nearest_zero((*arrived)->counter - number - s.counter_at_sync, *s.counter)];
      ++voters;
    }
  }
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == votes.end() || 2 * most->second <= voters) return;
  if (timer_.confirm(number + most->first) || most->first == 0 || most->second < 2) return;
  for (Stream& s : streams_)
    if (s.counter_at_sync >= 0)
      s.counter_at_sync = wrapped(s.counter_at_sync + most->first, *s.counter);
}

bool SyncMatcher::belongs_to_sync(Stream& s, const Arrived& arrived) {
  if (!s.counter) return true;
  const std::int64_t at_sync = wrapped(arrived.counter - timer_.opened_number(), *s.counter);
  if (s.counter_at_sync == at_sync) {
    s.disagreements = 0;
    return true;
  }
  if (!arrived.in_window || (s.counter_at_sync >= 0 && ++s.disagreements < kRestartedAfter))
    return false;
  s.counter_at_sync = at_sync;
  s.disagreements = 0;
  assign_kept(s);
  return true;
}

/// Keeps frames that may belong to the next SYNC, which was lost, until the first frame of the node
/// within the window decides.
void SyncMatcher::keep_unassigned(Stream& s) {
  for (auto* arrived : {&s.first, &s.last}) {
    if (!*arrived) continue;
    if (s.unassigned.size() == kMaxUnassigned) {
      s.unassigned.erase(s.unassigned.begin());
      ++s.late;
    }
    (*arrived)->values.number = timer_.opened_number();
    s.unassigned.push_back(*std::move(*arrived));
  }
}

void SyncMatcher::assign_kept(Stream& s) {
  for (Arrived& a : std::exchange(s.unassigned, {})) {
    const bool matches_sync = wrapped(a.counter - a.values.number, *s.counter) == s.counter_at_sync;
    s.late += !(matches_sync && timer_.attach_earlier(std::move(a.values)));
  }
}

/// Delivers the frame of the SYNC and counts the others. When a node without a counter sent no
/// frame after the last SYNC and two after this one, the first of them is late.
void SyncMatcher::deliver(Stream& s) {
  const auto in_window = [](const std::optional<Arrived>& a) { return a && a->in_window; };
  if (s.counter && s.counter_at_sync < 0 && !in_window(s.first) && !in_window(s.last))
    return keep_unassigned(s);
  const bool late_first = !s.counter && s.last && !s.came_after_last_sync;
  std::optional<Arrived>* taken = nullptr;
  if (!late_first && belongs_to_sync(s, *s.first)) taken = &s.first;
  const bool other = s.last && (!s.counter || s.last->counter != s.first->counter);
  if (taken == nullptr && other && belongs_to_sync(s, *s.last)) taken = &s.last;
  const int late = taken == nullptr ? s.count : taken == &s.last ? 1 : 0;
  const bool second_is_late = s.counter && taken == &s.first && other;
  s.late += late + (second_is_late ? 1 : 0);
  s.duplicates += s.count - (taken != nullptr ? 1 : 0) - late - (second_is_late ? 1 : 0);
  if (taken != nullptr) timer_.attach(std::move((*taken)->values));
}

void SyncMatcher::finish() {
  flush();
  for (Stream& s : streams_)
    s.late += static_cast<std::int64_t>(std::exchange(s.unassigned, {}).size());
  timer_.finish();
}

void SyncMatcher::count(int node, CanNodeCounters& counters) const {
  for (const Stream& s : streams_) {
    if (s.node != node) continue;
    counters.late += s.late;
    counters.duplicates += s.duplicates;
    counters.unplaced += s.unplaced;
  }
}

}  // namespace framewatch::drivers
