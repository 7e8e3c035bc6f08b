// SPDX-License-Identifier: MIT
#include "estimator/gap/model_learner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kMinChange = 0.05;
constexpr double kEnough = 1.0 / 3;  // of learn_s

}  // namespace

ModelLearner::ModelLearner(int parameters, int elements, double learn_s)
    : elements_(static_cast<std::size_t>(elements)), learn_s_(learn_s), joined_(kMax) {
  for (JoinedWindow& s : joined_) {
    s.value.assign(static_cast<std::size_t>(parameters), kNaN);
    s.std_error = s.value;
  }
}

bool ModelLearner::push(const WindowEstimate& e) {
  if (complete_ || e.window != 0 || !windows_.take(e)) return complete_;
  add(e);
  if (const auto found = change()) {
    complete_ = length_s(0, found->before_end) >= kEnough * learn_s_;
    if (complete_)
      keep(0, found->before_end);
    else
      keep(found->after_begin, count_);
  } else if (count_ > kConfirming && length_s(0, count_ - kConfirming) >= learn_s_) {
    complete_ = true;
    keep(0, count_ - kConfirming);
  }
  return complete_;
}

std::vector<WindowMean> ModelLearner::learned() const {
  std::vector<WindowMean> out;
  for (std::size_t p = 0; p < joined_.front().value.size(); ++p) {
    out.push_back(mean_of(values(p), 0, count_));
    if (2 * static_cast<std::size_t>(out.back().count) < count_) out.back() = {kNaN, kNaN, 0};
  }
  return out;
}

std::vector<WindowValue> ModelLearner::values(std::size_t p) const {
  std::vector<WindowValue> out;
  for (std::size_t i = 0; i < count_; ++i)
    out.push_back({joined_[i].start, joined_[i].end, joined_[i].value[p], joined_[i].std_error[p]});
  return out;
}

void ModelLearner::add(const WindowEstimate& e) {
  if (count_ == kMax) join_neighbors();
  JoinedWindow& s = joined_[count_++];
  s.start = e.start;
  s.end = e.end;
  s.length_s = SeparateWindows::length_s(e);
  for (std::size_t p = 0; p < s.value.size(); ++p) {
    const bool shown = e.reason[p] == Observability::observable;
    s.value[p] = shown ? e.value[p] : kNaN;
    s.std_error[p] = shown ? e.std_error[p] : kNaN;
  }
}

void ModelLearner::join_neighbors() {
  for (std::size_t i = 0; i < kMax / 2; ++i) {
    const JoinedWindow &a = joined_[2 * i], &b = joined_[2 * i + 1];
    JoinedWindow both = a;
    both.end = b.end;
    both.length_s += b.length_s;
    for (std::size_t p = 0; p < a.value.size(); ++p) {
      if (std::isnan(b.value[p])) continue;
      const double own = std::isnan(a.value[p]) ? 0 : 1 / (a.std_error[p] * a.std_error[p]);
      const double weight = own + 1 / (b.std_error[p] * b.std_error[p]);
      both.value[p] = b.value[p] + (own > 0 ? own / weight * (a.value[p] - b.value[p]) : 0);
      both.std_error[p] = 1 / std::sqrt(weight);
    }
    joined_[i] = std::move(both);
  }
  count_ = kMax / 2;
}

void ModelLearner::keep(std::size_t from, std::size_t to) {
  std::rotate(joined_.begin(), joined_.begin() + static_cast<std::ptrdiff_t>(from),
              joined_.begin() + static_cast<std::ptrdiff_t>(to));
  count_ = to - from;
}

std::optional<ChangePoint> ModelLearner::change() const {
  std::optional<ChangePoint> first;
  for (std::size_t p = 0; p < elements_; ++p)
    if (const auto found = find_change(values(p), kMinChange))
      if (!first || found->errors() > first->errors()) first = found;
  return first;
}

double ModelLearner::length_s(std::size_t from, std::size_t to) const {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += joined_[i].length_s;
  return sum;
}

}  // namespace framewatch::estimator
