// SPDX-License-Identifier: MIT
#include "estimator/watch/baseline.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
Baseline::Baseline(std::size_t parameters)
    : value(parameters, kNaN),
      std_error(parameters, kNaN),
      degc(parameters, kNaN),
      by_amplitude(parameters) {}

std::vector<double> Baseline::flat_points() const {
  std::vector<double> out;
  for (const std::vector<AmplitudePoint>& points : by_amplitude) {
    out.push_back(static_cast<double>(points.size()));
    for (const AmplitudePoint& p : points)
      out.insert(out.end(), {p.amplitude_m, p.value, p.std_error});
  }
  return out;
}

bool Baseline::take_points(const std::vector<double>& numbers) {
  by_amplitude.assign(value.size(), {});
  std::size_t at = 0;
  for (std::vector<AmplitudePoint>& points : by_amplitude) {
    if (at >= numbers.size()) return false;
    const double count = numbers[at++];
    if (!(count >= 0 && count <= AmplitudeBins::kBins)) return false;
    for (int i = 0; i < static_cast<int>(count); ++i, at += 3) {
      if (at + 3 > numbers.size()) return false;
      const AmplitudePoint p{numbers[at], numbers[at + 1], numbers[at + 2]};
      if (!p.valid()) return false;
      points.push_back(p);
    }
  }
  return at == numbers.size();
}

bool Baseline::knows(std::size_t p) const {
  return std::isfinite(value[p]);
}

int Baseline::known() const {
  return static_cast<int>(
      std::count_if(value.begin(), value.end(), [](double v) { return std::isfinite(v); }));
}

bool Baseline::holds(const Baseline& other) const {
  for (std::size_t p = 0; p < value.size(); ++p)
    if (other.knows(p) && other.value[p] != value[p]) return false;
  return true;
}

BaselineLearner::BaselineLearner(const std::vector<Watched>& watched, double learn_s,
                                 bool amplitude)
    : watched_(watched),
      learn_s_(learn_s),
      amplitude_(amplitude),
      sums_(watched.size()),
      recent_(watched.size()) {}

bool BaselineLearner::push(const WindowEstimate& e, double degc) {
  if (e.window != 0) return false;
  remember(e);
  if (!windows_.take(e)) return false;
  bool any = false;
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    Sum& sum = sums_[p];
    if (sum.complete || !watched_[p].counts(e, p)) continue;
    if (sum.count++ == 0) sum.first = e.value[p];
    const double weight = 1 / (e.std_error[p] * e.std_error[p]);
    const double off = e.value[p] - sum.first;
    sum.learned_s += SeparateWindows::length_s(e);
    sum.weight += weight;
    sum.value += weight * off;
    sum.square += weight * off * off;
    if (!std::isnan(degc)) {
      sum.degc_weight += weight;
      sum.degc += weight * degc;
    }
    if (amplitude_ && e.amplitude[p] > 0) {
      ++sum.with_amplitude;
      sum.bins.push(recent_[p].at(seconds_of(e.end)), off / sum.first,
                    weight * sum.first * sum.first);
    }
    sum.complete = enough(p);
    any = any || sum.complete;
  }
  return any;
}

void BaselineLearner::remember(const WindowEstimate& e) {
  if (!amplitude_ || e.status != WindowStatus::valid) return;
  for (std::size_t p = 0; p < recent_.size(); ++p)
    if (!sums_[p].complete && watched_[p].counts(e, p) && e.amplitude[p] > 0)
      recent_[p].push(seconds_of(e.end), e.amplitude[p]);
}

bool BaselineLearner::enough(std::size_t p) const {
  if (sums_[p].learned_s < learn_s_) return false;
  if (watched_[p].least_change == 0) return true;
  const Mean m = mean(sums_[p]);
  return m.std_error <= kExact * watched_[p].least_change * m.value;
}

BaselineLearner::Mean BaselineLearner::mean(const Sum& sum) {
  const double off = sum.value / sum.weight;
  const double scatter = std::max(sum.square - sum.weight * off * off, 0.0);
  const double excess = sum.with_amplitude == sum.count ? sum.bins.excess()
                        : sum.count > 1                 ? scatter / (sum.count - 1)
                                                        : 1.0;
  return {sum.first + off, std::sqrt(std::max(excess, 1.0) / sum.weight),
          sum.degc / sum.degc_weight};  // 0 / 0 is NaN: not known
}

void BaselineLearner::put(const Sum& sum, std::size_t p, Baseline& out) {
  const Mean m = mean(sum);
  out.value[p] = m.value;
  out.std_error[p] = m.std_error;
  out.degc[p] = m.degc;
  if (sum.with_amplitude == sum.count) out.by_amplitude[p] = sum.bins.points(sum.first);
}

Baseline BaselineLearner::baseline() const {
  Baseline out(sums_.size());
  for (std::size_t p = 0; p < sums_.size(); ++p)
    if (sums_[p].complete) put(sums_[p], p, out);
  return out;
}

Baseline BaselineLearner::so_far() const {
  Baseline out(sums_.size());
  for (std::size_t p = 0; p < sums_.size(); ++p)
    if (windows_.most(sums_[p].count)) put(sums_[p], p, out);
  return out;
}

}  // namespace framewatch::estimator
