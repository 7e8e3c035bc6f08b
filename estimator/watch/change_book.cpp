// SPDX-License-Identifier: MIT
#include "estimator/watch/change_book.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/watch/watched.h"

namespace framewatch::estimator {
namespace {

constexpr double kJudged = 1;  // main windows behind a change before other changes may begin
constexpr double kHold = 3;    // main windows after which others are judged anyway
constexpr double kCommonEvidence =
    0.4;  // share of the threshold at which single elements wait for the common change

constexpr double kMinBehind_s = 2;    // shortest windows behind a change that give a first size
constexpr double kOfLeak = 0.5;       // standard error of the leak over its largest value
constexpr double kWait = 0.3;         // of its length, by which a longer window may begin later
constexpr double kSharper = 0.7;      // republish when the error falls to this share
constexpr double kMovedFar = 3;       // errors by which a less exact size must move
constexpr double kMoved = 2;          // errors by which a size must move to be republished
constexpr double kRefuted = 4;        // main windows behind a change after which it may be refuted
constexpr double kRefined = 2;        // main windows until its time is fixed
constexpr double kMinBefore = 0.005;  // error of the value before a change, relative

}  // namespace

ChangeBook::ChangeBook(const ParameterTable& table, const std::vector<Watched>& watched,
                       const std::vector<double>& windows_s, double long_window_s, double threshold,
                       const ChangeModel& model)
    : elements_(static_cast<std::size_t>(table.elements())),
      model_(model),
      watched_(watched),
      frame_(elements_),
      order_(windows_s.size()),
      threshold_(threshold),
      lengths_s_(windows_s),
      baseline_(watched.size()),
      long_baseline_(watched.size()),
      detectors_(windows_s.size() + 1, ChangeDetector(baseline_, watched, threshold)),
      histories_(detectors_.size(), WindowHistory(elements_ + 1)),
      scatter_(detectors_.size() * (elements_ + 1)),
      records_(elements_ + 1),
      judged_(watched.size()),
      common_(1),
      median_(elements_),
      held_(watched.size()) {
  lengths_s_.push_back(long_window_s);
  if (!model_.is_of(elements_)) model_ = usual_change_model(table);
  for (std::size_t p = 0; p < elements_; ++p) {
    const Parameter& parameter = table[static_cast<int>(p)];
    frame_[p] = parameter.kind == ParameterKind::frame_stiffness && watched[p].least_change > 0;
    if (frame_[p] != 0) least_of_all_ = std::min(least_of_all_, watched[p].least_change);
    records_[p].parameter = static_cast<int>(p);
  }
  records_[all()].parameter = ChangeRecord::kEverything;
  of_all_.assign(detectors_.size(),
                 ChangeDetector(Baseline(1), {Watched{least_of_all_}}, threshold));
  // The main window first, then longer ones, then shorter ones, the longest first.
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    const auto rank = [&](std::size_t w) {
      return w == 0 ? 0 : windows_s[w] > windows_s[0] ? 1 : 2;
    };
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return rank(a) == 1 ? windows_s[a] < windows_s[b] : windows_s[a] > windows_s[b];
  });
  news_.reserve(2 * elements_ + 2);
  times_.reserve(detectors_.size());
  alone_.reserve(elements_);
}

/// Returns the baseline of the common change: 1, with the mean error of the frames.
Baseline ChangeBook::common_baseline(std::size_t window) const {
  Baseline common(1);
  double error = 0, count = 0;
  for (std::size_t p = 0; p < elements_; ++p) {
    if (frame_[p] == 0 || !baseline_of(window).knows(p)) continue;
    error += baseline_error(window, p);
    ++count;
  }
  if (count > 0) common.value[0] = 1, common.std_error[0] = error / count;
  return common;
}

void ChangeBook::set_baseline(const Baseline& baseline) {
  baseline_ = baseline;
  const Baseline common = common_baseline(0);
  for (std::size_t w = 0; w + 1 < detectors_.size(); ++w) {
    detectors_[w].set_baseline(baseline);
    of_all_[w].set_baseline(common);
  }
}

void ChangeBook::begin_long(const Baseline& baseline, const std::vector<Watched>& watched) {
  long_baseline_ = baseline;
  detectors_.back() = ChangeDetector(baseline, watched, threshold_);
  of_all_.back().set_baseline(common_baseline(detectors_.size() - 1));
  of_all_.back().forget(0);
  histories_.back().clear();
}

double ChangeBook::baseline_error(std::size_t window, std::size_t element) const {
  const Baseline& b = baseline_of(window);
  if (element < elements_) return b.std_error[element] / b.value[element];
  return of_all_[window].baseline().std_error[0];
}

ChangeDetector& ChangeBook::detector_of(std::size_t window, std::size_t element) {
  return element == all() ? of_all_[window] : detectors_[window];
}

double ChangeBook::usual_error(std::size_t window, std::size_t element, double own) const {
  const ChangeDetector& d = element == all() ? of_all_[window] : detectors_[window];
  return std::max(own, d.usual_error(in_detector(element)));
}

const ChangeRecord* ChangeBook::record(int parameter) const {
  const std::size_t i =
      parameter == ChangeRecord::kEverything ? all() : static_cast<std::size_t>(parameter);
  return i < records_.size() && records_[i].id != 0 ? &records_[i] : nullptr;
}

const std::vector<Alarm>& ChangeBook::push(const WindowEstimate& judged,
                                           const std::vector<Explained>& explained,
                                           const std::vector<std::uint8_t>& doubted) {
  news_.clear();
  judged_ = judged;
  const auto window = static_cast<std::size_t>(judged.window);
  find_common(explained);
  for (std::size_t p = 0; p < elements_; ++p)
    held_[p] = records_[p].id == 0 && judged.start < gate_ ? 1 : 0;
  tolerate();
  detectors_[window].push(judged_, held_);
  of_all_[window].push(common_);
  remember(explained);
  for (Record& r : records_)
    if (r.id != 0 && is_long(window) == is_long(r.detector)) update(r);
  find(doubted);
  return news_;
}

/// Finds the common change of the frames without a record. While it has a record, the other
/// elements are judged relative to it.
void ChangeBook::find_common(const std::vector<Explained>& explained) {
  const auto window = static_cast<std::size_t>(judged_.window);
  const Baseline& b = baseline_of(window);
  median_.clear();
  double count = 0, frames = 0;
  common_off_ = common_explained_ = 0;
  for (std::size_t p = 0; p < elements_; ++p) {
    if (frame_[p] == 0 || !b.knows(p)) continue;
    ++frames;
    if (records_[p].id != 0 || !watched_[p].counts(judged_, p)) continue;
    const double own = usual_error(window, p, judged_.std_error[p] / b.value[p]);
    median_.add(judged_.value[p] / b.value[p] - 1, std::hypot(own, baseline_error(window, p)));
    common_off_ += explained[p].off;
    common_explained_ += explained[p].std_error;
    ++count;
  }
  const CommonChange::Mean mean =
      median_.mean(static_cast<std::size_t>(std::max(2.0, std::ceil(frames / 2))));
  common_.window = judged_.window;
  common_.start = judged_.start;
  common_.end = judged_.end;
  common_.value[0] = 1 + mean.off;
  common_.std_error[0] = mean.std_error;
  common_.prior_share[0] = common_.noise_share[0] = 0;
  common_.reason[0] = mean.known ? Observability::observable : Observability::quiet;
  if (count > 0) common_off_ /= count, common_explained_ /= count;
  const Record& r = records_[all()];
  if (r.id == 0) return;
  const bool same = is_long(window) == is_long(r.detector);
  const double scale = 1 + (mean.known ? mean.off : same ? r.change.ratio : 0.0);
  for (std::size_t p = 0; p < elements_; ++p)
    if (frame_[p] != 0) judged_.value[p] /= scale;
}

void ChangeBook::remember(const std::vector<Explained>& explained) {
  const auto window = static_cast<std::size_t>(judged_.window);
  const Baseline& b = baseline_of(window);
  const auto shown = [&](std::size_t p) {
    return watched_[p].least_change > 0 && b.knows(p) && watched_[p].counts(judged_, p);
  };
  bool any = false;
  for (std::size_t p = 0; p < elements_; ++p) any = any || shown(p);
  if (!any) return;
  const std::size_t place = histories_[window].add(judged_.start, judged_.end);
  if (place == WindowHistory::kMax) return;
  const std::size_t main = is_long(window) ? window : 0;
  const auto put = [&](std::size_t element, double off, double own, double common) {
    UsualScatter& scatter = scatter_[window * (elements_ + 1) + element];
    const double error = usual_error(window, element, own);
    // The effect of the conditions is not scatter.
    if (records_[element].id == 0 && judged_.start >= gate_ && common <= least_change(element))
      scatter.push(judged_.start, judged_.end, off, error);
    const double slow = scatter_[main * (elements_ + 1) + element].slow();
    histories_[window].put(place, element,
                           {off, std::sqrt(scatter.excess()) * error, std::hypot(common, slow)});
  };
  for (std::size_t p = 0; p < elements_; ++p)
    if (shown(p))
      put(p, judged_.value[p] / b.value[p] - 1 + explained[p].off,
          judged_.std_error[p] / b.value[p], explained[p].std_error);
  if (common_.reason[0] == Observability::observable)
    put(all(), common_.value[0] - 1 + common_off_, common_.std_error[0], common_explained_);
}

/// Tolerates what a change of one element may move other values by, because the model is inexact.
void ChangeBook::tolerate() {
  double of_all = 0;
  for (std::size_t p = 0; p < elements_; ++p) {
    double sum = 0;
    for (std::size_t q = 0; q < elements_; ++q)
      if (q != p && records_[q].id != 0)
        sum += model_.leak[q * elements_ + p] * std::abs(records_[q].change.ratio);
    for (ChangeDetector& d : detectors_) d.tolerate(p, sum);
    of_all = std::max(of_all, sum);
  }
  for (ChangeDetector& d : of_all_) d.tolerate(0, of_all);
}

/// Returns true if one common change describes the frames without a record better than separate
/// changes, each of which costs the detectors' threshold.
bool ChangeBook::all_alike(std::size_t window, Time since) {
  const WindowHistory& h = histories_[window];
  alone_.clear();
  for (std::size_t p = 0; p < elements_; ++p) {
    if (frame_[p] == 0 || records_[p].id != 0) continue;
    double count = 0, own = 0, off = 0;
    for (std::size_t i = h.first(p, since); i < h.size(); ++i) {
      if (!h.has(i, p)) continue;
      const WindowHistory::Value v = h.value(i, p);
      ++count;
      own += 1 / (v.std_error * v.std_error);
      off += v.off / (v.std_error * v.std_error);
    }
    if (count == 0) continue;
    const double separate = 1 + (count - 1) / ChangeDetector::kPhases;
    const double error = std::hypot(std::sqrt(count / separate / own), baseline_error(window, p));
    alone_.push_back({off / own, error});
  }
  return are_alike(alone_, 2 * threshold_);
}

/// Returns true if the windows behind the newest changes have been judged.
bool ChangeBook::settled() const {
  return std::none_of(records_.begin(), records_.end(), [&](const Record& r) {
    return r.id != 0 && r.state == ChangeState::changing && r.behind_s < kJudged * length_s(r) &&
           is_long(r.detector) == is_long(static_cast<std::size_t>(judged_.window)) &&
           seconds_of(judged_.end - r.found) < kHold * length_s(r);
  });
}

void ChangeBook::find(const std::vector<std::uint8_t>& doubted) {
  const auto window = static_cast<std::size_t>(judged_.window);
  if (of_all_[window].changed(0) && records_[all()].id == 0) {
    if (all_alike(window, of_all_[window].change(0).since)) {
      for (Record& r : records_)
        if (r.id != 0 && !r.measured()) end(r, ChangeReason::of_all);
      return begin(all(), window);
    }
    of_all_[window].forget(0);
  }
  if (!settled()) return;
  const bool lost = std::any_of(records_.begin(), records_.end(),
                                [](const Record& r) { return r.id != 0 && r.change.ratio < 0; });
  std::size_t strongest = all();
  double most = 0;
  for (std::size_t p = 0; p < elements_; ++p) {
    const int sign = detectors_[window].sign(static_cast<int>(p));
    if (sign == 0 || records_[p].id != 0) continue;
    if (sign > 0 && (lost || doubted[p] != 0)) continue;
    double common = 0;
    for (const ChangeDetector& d : of_all_) common = std::max(common, d.evidence(0, sign));
    if (frame_[p] != 0 && common >= kCommonEvidence && records_[all()].id == 0 &&
        all_alike(window, detectors_[window].change(static_cast<int>(p)).since))
      continue;
    const Baseline& b = baseline_of(window);
    const double z =
        std::abs(judged_.value[p] / b.value[p] - 1) / judged_.std_error[p] * b.value[p];
    const double evidence = detectors_[window].evidence(static_cast<int>(p), sign) +
                            1e-3 * std::min(std::isfinite(z) ? z : 0.0, 100.0);
    if (evidence <= most) continue;
    most = evidence;
    strongest = p;
  }
  if (strongest != all()) begin(strongest, window);
}

void ChangeBook::begin(std::size_t element, std::size_t window) {
  Record& r = records_[element];
  const int parameter = r.parameter;
  r = {};
  r.id = ++last_id_;
  r.parameter = parameter;
  r.state = ChangeState::changing;
  r.change = detector_of(window, element).change(in_detector(element));
  r.change.latest = r.change.since + (judged_.end - judged_.start);
  r.detector = window;
  r.found = judged_.end;
  r.first = r.change.since;
  refit_size(r);
  forget_others();
  const Change now = measured(r);
  if (is_significant(r, now)) {
    r.state = ChangeState::measured;
    r.change = now;
  }
  announce(r, AlarmState::raised, ChangeReason::none);
}

void ChangeBook::announce(const Record& r, AlarmState state, ChangeReason reason) {
  news_.push_back({r.id, state, r.parameter, r.change, judged_.end, r.measured(), reason});
}

void ChangeBook::end(Record& r, ChangeReason reason) {
  announce(r, AlarmState::cleared, reason);
  forget(index_of(r));
  const int parameter = r.parameter;
  r = {};
  r.parameter = parameter;
}

void ChangeBook::forget(std::size_t element) {
  for (std::size_t w = 0; w < detectors_.size(); ++w)
    detector_of(w, element).forget(static_cast<std::size_t>(in_detector(element)));
}

void ChangeBook::forget_others() {
  for (std::size_t p = 0; p < elements_; ++p)
    if (records_[p].id == 0) forget(p);
}

void ChangeBook::update(Record& r) {
  bool further = false;
  if (r.young)
    refit_size(r);
  else
    further = extend_size(r);
  publish(r, further);
}

/// Estimates the time from the windows of every length that still cover the time before the change.
void ChangeBook::refine_time(Record& r) {
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

void ChangeBook::refit_size(Record& r) {
  if (seconds_of(judged_.end - r.found) <= kRefined * length_s(r)) refine_time(r);
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

/// Returns the next window for the size: the one that begins first, or a longer one that begins
/// soon after; null if there is no such window.
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

/// Adds the newest window to the size. Returns true when the element has changed further.
bool ChangeBook::extend_size(Record& r) {
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

/// Returns the model's part of the standard error of a size. The size is r times the change, r
/// about 1 with an error of `own`; the change is the size over r, so large errors count more.
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

/// Returns true if the windows behind a change show that there is no change. The model's error does
/// not count, because it only scales the size. Conditions that may explain a deviation keep the
/// error large; then the detector, which excludes them, decides.
bool ChangeBook::is_refuted(const Record& r) const {
  const std::size_t element = index_of(r);
  const double error = std::hypot(r.size.std_error(), baseline_error(r.detector, element));
  return r.size.known() && r.behind_s >= kRefuted * length_s(r) &&
         error <= least_change(element) / kNothing && std::abs(r.size.ratio()) < kNothing * error;
}

bool ChangeBook::is_significant(const Record& r, const Change& now) const {
  return r.size.known() && r.behind_s >= kMinBehind_s &&
         std::abs(now.ratio) >= kWorth * now.std_error && now.ratio * r.change.ratio > 0;
}

void ChangeBook::publish(Record& r, bool further) {
  const Change now = measured(r);
  if (!detector_of(r.detector, index_of(r)).changed(in_detector(index_of(r))))
    return end(r, ChangeReason::back);
  if (is_refuted(r)) return end(r, ChangeReason::not_confirmed);
  if (!r.measured()) {
    if (!is_significant(r, now)) return;
    r.state = ChangeState::measured;
    r.change = now;
    return announce(r, AlarmState::changed, ChangeReason::none);
  }
  const bool less_exact = now.std_error > r.change.std_error;
  // A less exact size must contradict the published one.
  const double most = less_exact ? kMovedFar * std::hypot(now.std_error, r.change.std_error)
                                 : kMoved * r.change.std_error;
  const bool moved = std::abs(now.ratio - r.change.ratio) > most;
  if (!further && !moved && now.std_error > kSharper * r.change.std_error) return;
  r.change = now;
  announce(r, AlarmState::changed,
           further || less_exact ? ChangeReason::further : ChangeReason::none);
}

}  // namespace framewatch::estimator
