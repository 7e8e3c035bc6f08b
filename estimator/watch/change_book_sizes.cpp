// The time and the size of a change that a record is of, and when they are told.
#include <algorithm>
#include <cmath>

#include "estimator/watch/change_book.h"
#include "estimator/watch/separate_windows.h"

namespace framewatch::estimator {
namespace {

constexpr double kMinBehind_s = 2;  // length of the windows that a first number takes
constexpr double kOfLeak = 0.5;   // standard error of what a change moves others by, over the most
constexpr double kWait = 0.3;     // of its length, that a longer window may begin later
constexpr double kSharper = 0.7;  // of the error told: a smaller one is told, too
constexpr double kMovedFar = 3;   // the same where the new size is less exact
constexpr double kMoved = 2;      // errors told that a size moves by before it is told again
constexpr double kRefuted = 4;    // lengths of main windows behind a change that is none
constexpr double kRefined = 2;    // the same until its time is found no more
constexpr double kMinBefore = 0.005;  // a value before a change may be off by, relative

}  // namespace

void ChangeBook::follow(Record& r) {
  bool further = false;
  if (r.young)
    size_anew(r);
  else
    further = size_on(r);
  tell(r, further);
}

/// From the windows of every length that still has what was before the change.
void ChangeBook::find_time(Record& r) {
  const std::size_t element = index_of(r);
  times_.clear();
  SensorClock::duration shortest = SensorClock::duration::max(), longest{};
  for (std::size_t w = 0; w < histories_.size(); ++w) {
    if (is_long(w) != is_long(r.detector)) continue;
    const WindowHistory& h = histories_[w];
    const std::size_t oldest = h.first(element, Time::min());
    if (oldest == h.size() || h.end(oldest) > r.first) continue;
    times_.push_back(&h);
    shortest = std::min(shortest, h.end(oldest) - h.start(oldest));
    longest = std::max(longest, h.end(oldest) - h.start(oldest));
  }
  if (times_.empty()) return;
  const double before = std::hypot(kMinBefore, baseline_error(r.detector, element));
  const auto time = time_of_change(times_, element, before, r.first - longest, judged_.end,
                                   shortest / ChangeDetector::kPhases);
  if (!time) return;
  r.change.since = time->best;
  r.change.earliest = time->earliest;
  r.change.latest = time->latest;
}

void ChangeBook::size_anew(Record& r) {
  if (seconds_of(judged_.end - r.found) <= kRefined * length_s(r)) find_time(r);
  if (!r.measured() && r.change.latest > gate_) {
    gate_ = r.change.latest;
    forget_others();
  }
  const std::size_t element = index_of(r);
  r.size = {};
  r.behind_s = 0;
  r.until = r.change.latest;
  for (;;) {
    std::size_t at = 0;
    const WindowHistory* h = next_behind(r, at);
    if (h == nullptr) break;
    const WindowHistory::Value v = h->value(at, element);
    r.size.add(v.off, v.std_error, v.common_error);
    r.behind_s += seconds_of(h->end(at) - h->start(at));
    r.until = h->end(at);
  }
  const WindowHistory& oldest = histories_[is_long(r.detector) ? r.detector : 0];
  r.young = oldest.size() < WindowHistory::kMax || oldest.start(0) < r.change.earliest;
}

/// The next window to size by: the one that begins first, or a longer one that begins soon after.
const WindowHistory* ChangeBook::next_behind(const Record& r, std::size_t& at) const {
  const std::size_t element = index_of(r);
  if (is_long(r.detector)) {
    const WindowHistory& h = histories_[r.detector];
    at = h.first(element, r.until);
    return at < h.size() ? &h : nullptr;
  }
  Time earliest = Time::max();
  for (const std::size_t w : order_)
    if (const std::size_t i = histories_[w].first(element, r.until); i < histories_[w].size())
      earliest = std::min(earliest, histories_[w].start(i));
  for (const std::size_t w : order_) {
    const WindowHistory& h = histories_[w];
    at = h.first(element, r.until);
    if (at < h.size() &&
        seconds_of(h.start(at) - earliest) <= kWait * seconds_of(h.end(at) - h.start(at)))
      return &h;
  }
  return nullptr;
}

/// Adds the newest window. True when the element has changed further.
bool ChangeBook::size_on(Record& r) {
  const auto window = static_cast<std::size_t>(judged_.window);
  const std::size_t element = index_of(r);
  const WindowHistory& h = histories_[window];
  const std::size_t at = h.first(element, std::max(r.until, judged_.start));
  const bool shorter = lengths_s_[window] < length_s(r);
  if (shorter || at >= h.size() || h.end(at) != judged_.end) return false;
  const WindowHistory::Value v = h.value(at, element);
  r.until = h.end(at);
  r.behind_s += seconds_of(h.end(at) - h.start(at));
  return r.size.push(v.off, v.std_error, v.common_error);
}

/// What the model's error makes of a size, one standard error. The size is r times the change, r
/// about 1 with an error of `own`: the change is the size over r, so that the error counts more
/// where it is large.
double ChangeBook::model_error(const Record& r, double ratio) const {
  if (r.parameter == ChangeRecord::kEverything) return 0;
  const std::size_t p = index_of(r);
  const double own = std::min(model_.own[p], 1.0);
  double others = 0;
  for (std::size_t q = 0; q < elements_; ++q)
    if (q != p && records_[q].id != 0)
      others =
          std::hypot(others, kOfLeak * model_.leak[q * elements_ + p] * records_[q].change.ratio);
  return std::hypot(own / (1 - own / 2) * ratio, others);
}

Change ChangeBook::measured(const Record& r) const {
  Change out = r.change;
  if (!r.size.known()) return out;
  out.ratio = r.size.ratio();
  out.std_error = std::hypot(r.size.std_error(), baseline_error(r.detector, index_of(r)),
                             model_error(r, out.ratio));
  return out;
}

/// Whether the windows behind a change know its size well enough to say that it is none. The
/// model's error is about the size alone; what the conditions may explain keeps the error large,
/// and then the detector, which leaves that out, knows better.
bool ChangeBook::is_none(const Record& r) const {
  const std::size_t element = index_of(r);
  const double error = std::hypot(r.size.std_error(), baseline_error(r.detector, element));
  return r.size.known() && r.behind_s >= kRefuted * length_s(r) &&
         error <= least_change(element) / kNothing && std::abs(r.size.ratio()) < kNothing * error;
}

bool ChangeBook::worth_a_number(const Record& r, const Change& now) const {
  return r.size.known() && r.behind_s >= kMinBehind_s &&
         std::abs(now.ratio) >= kWorth * now.std_error && now.ratio * r.change.ratio > 0;
}

void ChangeBook::tell(Record& r, bool further) {
  const Change now = measured(r);
  if (!detector_of(r.detector, index_of(r)).changed(in_detector(index_of(r))))
    return end(r, ChangeReason::back);
  if (is_none(r)) return end(r, ChangeReason::not_confirmed);
  if (!r.measured()) {
    if (!worth_a_number(r, now)) return;
    r.state = ChangeState::measured;
    r.change = now;
    news_.push_back(
        {r.id, AlarmState::changed, r.parameter, now, judged_.end, true, ChangeReason::none});
    return;
  }
  const bool less_exact = now.std_error > r.change.std_error;
  // A less exact size must contradict the one told.
  const double most = less_exact ? kMovedFar * std::hypot(now.std_error, r.change.std_error)
                                 : kMoved * r.change.std_error;
  const bool moved = std::abs(now.ratio - r.change.ratio) > most;
  if (!further && !moved && now.std_error > kSharper * r.change.std_error) return;
  r.change = now;
  news_.push_back({r.id, AlarmState::changed, r.parameter, now, judged_.end, true,
                   further || less_exact ? ChangeReason::further : ChangeReason::none});
}

}  // namespace framewatch::estimator
