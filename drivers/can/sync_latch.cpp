#include "drivers/can/sync_latch.h"

#include <algorithm>
#include <map>
#include <utility>

namespace framewatch::drivers {
namespace {

/// Of the SYNC's period: frames later than this after it are of no known sample.
constexpr double kWindow = 0.95;
/// Who sends the SYNC may be held up, and nobody else tells the time.
constexpr double kPatience_us = 30e6;
constexpr int kSure = 5;  ///< frames in a row that make a node's new count
constexpr std::size_t kUnsureMost = 8;

StreamTimer::Settings settings_of(const CanBusMap& bus) {
  return {bus.sync_overflow > 0 ? CanTiming::counter : CanTiming::period, bus.sync_period_us,
          bus.sync_period_us, static_cast<double>(bus.sync_overflow), kPatience_us};
}

/// `value` in [0, 2^bits).
std::int64_t wrapped(std::int64_t value, const CanField& counter) {
  const std::int64_t modulus = std::int64_t{1} << std::min(counter.bits, 62);
  return (value % modulus + modulus) % modulus;
}

/// `value` in [-2^(bits-1), 2^(bits-1)).
std::int64_t nearest_zero(std::int64_t value, const CanField& counter) {
  const std::int64_t modulus = std::int64_t{1} << std::min(counter.bits, 62);
  const std::int64_t rest = wrapped(value, counter);
  return rest >= modulus / 2 ? rest - modulus : rest;
}

}  // namespace

SyncLatch::SyncLatch(const CanMap& map, int bus, HostSteps& steps, StreamTimer::Deliver deliver)
    : bus_(map.buses[static_cast<std::size_t>(bus)]), timer_(settings_of(bus_), steps) {
  timer_.on_delivery(std::move(deliver));
  for (std::size_t n = 0; n < map.nodes.size(); ++n) {
    const CanNodeMap& node = map.nodes[n];
    if (node.bus != bus || node.timing != CanTiming::sync) continue;
    for (std::size_t m = 0; m < node.messages.size(); ++m) {
      Waiting waiting;
      waiting.node = static_cast<int>(n);
      waiting.message = static_cast<int>(m);
      waiting.counter = node.messages[m].counter;
      waiting_.push_back(std::move(waiting));
    }
  }
}

void SyncLatch::add(const CanFrame& frame, double host_us, TimedValues values) {
  const auto at = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& w) {
    return w.node == values.node && w.message == values.message;
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
  (at->count++ == 0 ? at->first : at->second) = Arrived{std::move(values), counter, in_window};
}

void SyncLatch::sync(const CanFrame& frame, double host_us) {
  if (bus_.sync_overflow > 0 && frame.length != 1) return;
  flush();
  sync_us_ = host_us;
  timer_.see(frame.data[0] % std::max<int>(bus_.sync_overflow, 1), host_us, {-1, -1, 0, {}});
}

void SyncLatch::flush() {
  if (sync_us_ < 0) return;
  agree_on_number();
  for (Waiting& w : waiting_) {
    if (w.count > 0) give(w);
    w.came_last_time = std::exchange(w.count, 0) > 0;
    w.first.reset();
    w.second.reset();
  }
}

/// What most nodes' counters say of the SYNC. When the SYNC cannot have that number it has been
/// numbered anew, or all nodes have.
void SyncLatch::agree_on_number() {
  const std::int64_t told = timer_.opened_number();
  std::map<std::int64_t, int> votes;  // by what is to be added to `told`
  int voters = 0;
  for (const Waiting& w : waiting_) {
    if (w.counter_at_sync < 0) continue;
    for (const auto* arrived : {&w.first, &w.second}) {
      if (!*arrived || !(*arrived)->in_window) continue;
      ++votes[nearest_zero((*arrived)->counter - told - w.counter_at_sync, *w.counter)];
      ++voters;
    }
  }
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == votes.end() || 2 * most->second <= voters) return;
  if (timer_.confirm(told + most->first) || most->first == 0 || most->second < 2) return;
  for (Waiting& w : waiting_)
    if (w.counter_at_sync >= 0)
      w.counter_at_sync = wrapped(w.counter_at_sync + most->first, *w.counter);
}

bool SyncLatch::belongs(Waiting& w, const Arrived& arrived) {
  if (!w.counter) return true;
  const std::int64_t at_sync = wrapped(arrived.counter - timer_.opened_number(), *w.counter);
  if (w.counter_at_sync == at_sync) {
    w.disagreements = 0;
    return true;
  }
  if (!arrived.in_window || (w.counter_at_sync >= 0 && ++w.disagreements < kSure)) return false;
  w.counter_at_sync = at_sync;
  w.disagreements = 0;
  place_unsure(w);
  return true;
}

/// So long after a SYNC they may be of the next one, lost: the node's first frame in time will
/// tell.
void SyncLatch::keep_unsure(Waiting& w) {
  for (auto* arrived : {&w.first, &w.second}) {
    if (!*arrived) continue;
    if (w.unsure.size() == kUnsureMost) {
      w.unsure.erase(w.unsure.begin());
      ++w.late;
    }
    (*arrived)->values.number = timer_.opened_number();
    w.unsure.push_back(*std::move(*arrived));
  }
}

void SyncLatch::place_unsure(Waiting& w) {
  for (Arrived& a : std::exchange(w.unsure, {})) {
    const bool its = wrapped(a.counter - a.values.number, *w.counter) == w.counter_at_sync;
    w.late += !(its && timer_.attach_earlier(std::move(a.values)));
  }
}

/// Of two frames without counter that came after none at all the first was late.
void SyncLatch::give(Waiting& w) {
  const auto in_window = [](const std::optional<Arrived>& a) { return a && a->in_window; };
  if (w.counter && w.counter_at_sync < 0 && !in_window(w.first) && !in_window(w.second))
    return keep_unsure(w);
  const bool late_first = !w.counter && w.second && !w.came_last_time;
  std::optional<Arrived>* taken = nullptr;
  if (!late_first && belongs(w, *w.first)) taken = &w.first;
  const bool other = w.second && (!w.counter || w.second->counter != w.first->counter);
  if (taken == nullptr && other && belongs(w, *w.second)) taken = &w.second;
  const int late = taken == nullptr ? w.count : taken == &w.second ? 1 : 0;
  const bool second_is_late = w.counter && taken == &w.first && other;
  w.late += late + (second_is_late ? 1 : 0);
  w.duplicates += w.count - (taken != nullptr ? 1 : 0) - late - (second_is_late ? 1 : 0);
  if (taken != nullptr) timer_.attach(std::move((*taken)->values));
}

void SyncLatch::finish() {
  flush();
  for (Waiting& w : waiting_)
    w.late += static_cast<std::int64_t>(std::exchange(w.unsure, {}).size());
  timer_.finish();
}

void SyncLatch::count(int node, CanNodeCounters& counters) const {
  for (const Waiting& w : waiting_) {
    if (w.node != node) continue;
    counters.late += w.late;
    counters.duplicates += w.duplicates;
    counters.unplaced += w.unplaced;
  }
}

}  // namespace framewatch::drivers
