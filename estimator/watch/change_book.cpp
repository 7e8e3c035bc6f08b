#include "estimator/watch/change_book.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/watch/separate_windows.h"

namespace framewatch::estimator {
namespace {

constexpr double kJudged = 1;  // lengths of main windows behind a change: others may be named
constexpr double kHold = 3;    // the same until other elements are judged nevertheless
constexpr double kCommonEvidence = 0.4;  // of what is asked for: an element alone waits for it

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

void ChangeBook::set_baseline(const Baseline& baseline) {
  baseline_ = baseline;
  Baseline common(1);
  double error = 0, count = 0;
  for (std::size_t p = 0; p < elements_; ++p) {
    if (frame_[p] == 0 || !baseline.knows(p)) continue;
    error += baseline_error(0, p);
    ++count;
  }
  if (count > 0) common.value[0] = 1, common.std_error[0] = error / count;
  for (std::size_t w = 0; w + 1 < detectors_.size(); ++w) {
    detectors_[w].set_baseline(baseline);
    of_all_[w].set_baseline(common);
  }
}

void ChangeBook::begin_long(const Baseline& baseline, const std::vector<Watched>& watched) {
  long_baseline_ = baseline;
  Baseline common(1);
  double error = 0, count = 0;
  for (std::size_t p = 0; p < elements_; ++p) {
    if (frame_[p] == 0 || !baseline.knows(p)) continue;
    error += baseline_error(detectors_.size() - 1, p);
    ++count;
  }
  if (count > 0) common.value[0] = 1, common.std_error[0] = error / count;
  detectors_.back() = ChangeDetector(baseline, watched, threshold_);
  of_all_.back().set_baseline(common);
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
    if (r.id != 0 && is_long(window) == is_long(r.detector)) follow(r);
  find(doubted);
  return news_;
}

/// Of frames that have no record of their own. Where everything has a record, the elements are
/// judged beside what they have in common.
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
    // What the conditions make of the element is no scatter.
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

/// What a change of one element may move the values of others by, because the model is not quite
/// right.
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

/// Whether the frames without a record are better described by what they have in common than by as
/// many changes of their own as they need, each of which costs what the detectors ask for.
bool ChangeBook::all_alike(std::size_t window, Time since) {
  const WindowHistory& h = histories_[window];
  alone_.clear();
  double weight = 0, sum = 0;
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
    weight += 1 / (error * error);
    sum += off / own / (error * error);
  }
  if (alone_.size() < 2) return false;
  const double price = 2 * threshold_, common = sum / weight;
  double alike = price, apart = 0;
  for (const auto& [off, error] : alone_) {
    alike += std::min(std::pow((off - common) / error, 2), price);
    apart += std::min(std::pow(off / error, 2), price);
  }
  return alike < apart;
}

/// Whether the windows behind the newest changes have been judged.
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
  size_anew(r);
  forget_others();
  const Change now = measured(r);
  if (worth_a_number(r, now)) {
    r.state = ChangeState::measured;
    r.change = now;
  }
  news_.push_back({r.id, AlarmState::raised, r.parameter, r.change, judged_.end, r.measured(),
                   ChangeReason::none});
}

void ChangeBook::end(Record& r, ChangeReason reason) {
  news_.push_back(
      {r.id, AlarmState::cleared, r.parameter, r.change, judged_.end, r.measured(), reason});
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

}  // namespace framewatch::estimator
